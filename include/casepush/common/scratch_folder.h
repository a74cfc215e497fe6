#pragma once

#include <filesystem>

namespace casepush {

/// An empty folder of its own, removed with all that is in it at the end.
class ScratchFolder {
 public:
  /// @throws InputError if the system's temporary folder cannot be written.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace casepush
