#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "casepush/common/scratch_folder.h"

namespace casepush {

/// A folder for a test to write files to.
class TemporaryFolder : public ScratchFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path() / name).parent_path());
    std::ofstream(path() / name) << text;
    return path() / name;
  }
};

}  // namespace casepush
