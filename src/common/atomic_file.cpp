#include "casepush/common/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;

bool writeAll(int descriptor, const std::string& content) {
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t count = ::write(descriptor, content.data() + written, content.size() - written);
    if (count < 0 && errno != EINTR) {
      return false;
    }
    written += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  return true;
}

/// Writes and closes. Returns 0, or the reason (errno) why it failed.
/// @param flush  To the disk; devices and pipes have none.
int writeTo(int descriptor, const std::string& content, bool flush) {
  if (descriptor < 0) {
    return errno;
  }
  const bool done = writeAll(descriptor, content) && (!flush || ::fsync(descriptor) == 0);
  const int reason = errno;
  if (::close(descriptor) != 0 && done) {
    return errno;
  }
  return done ? 0 : reason;
}

int replace(const fs::path& file, const std::string& content) {
  const std::string partial = file.string() + ".partial-" + std::to_string(::getpid());
  int reason = writeTo(::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666),
                       content, true);
  if (reason == 0 && std::rename(partial.c_str(), file.c_str()) != 0) {
    reason = errno;
  }
  if (reason != 0) {
    ::unlink(partial.c_str());
  }
  return reason;
}

int writeInto(const fs::path& device, const std::string& content) {
  // A pipe that nobody reads would block when it is opened, but not so.
  const int descriptor = ::open(device.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor >= 0) {
    ::fcntl(descriptor, F_SETFL, 0);
  }
  return writeTo(descriptor, content, false);
}

}  // namespace

void writeFileAtomically(const fs::path& file, const std::string& content) {
  if (file.empty()) {
    throw InputError("file", "its name is empty");
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  const bool is_replaced = !fs::exists(status) || fs::is_regular_file(status) ||
                           fs::is_directory(status);  // which fails and says so
  const bool is_link = fs::is_symlink(file, ignored) && fs::exists(status);
  const int reason = is_replaced ? replace(is_link ? fs::canonical(file, ignored) : file, content)
                                 : writeInto(file, content);
  if (reason != 0) {
    throw InputError(file.string(), std::string("cannot be written: ") + std::strerror(reason));
  }
}

}  // namespace casepush
