#include "atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

bool writeAll(int descriptor, const std::string& content) {
  std::size_t written = 0;
  while (written < content.size()) {
    const ssize_t count = ::write(descriptor, content.data() + written, content.size() - written);
    if (count < 0 && errno != EINTR) {
      return false;
    }
    written += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  return ::fsync(descriptor) == 0;
}

}  // namespace

void writeFileAtomically(const std::filesystem::path& file, const std::string& content) {
  const std::string partial = file.string() + ".partial-" + std::to_string(::getpid());
  const int descriptor = ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  bool done = descriptor >= 0 && writeAll(descriptor, content);
  int reason = errno;
  if (descriptor >= 0 && ::close(descriptor) != 0 && done) {
    done = false;
    reason = errno;
  }
  if (done && std::rename(partial.c_str(), file.c_str()) != 0) {
    done = false;
    reason = errno;
  }
  if (!done) {
    ::unlink(partial.c_str());
    throw InputError(file.string(), std::string("cannot be written: ") + std::strerror(reason));
  }
}

}  // namespace casepush
