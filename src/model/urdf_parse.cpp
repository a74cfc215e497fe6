#include "urdf_parse.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <system_error>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

/// Collects what urdfdom would print to stderr, for the length of its life.
class ParserLog : public console_bridge::OutputHandler {
 public:
  ParserLog() : previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~ParserLog() override { console_bridge::useOutputHandler(previous_); }
  ParserLog(const ParserLog&) = delete;
  ParserLog& operator=(const ParserLog&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
      errors_ += (errors_.empty() ? "" : "; ") + text;
    }
  }

  /// On one line.
  std::string errors() const {
    std::string line = errors_;
    for (char& c : line) {
      c = c == '\n' ? ' ' : c;
    }
    return line;
  }

 private:
  console_bridge::OutputHandler* previous_;
  std::string errors_;
};

std::string readFile(const std::filesystem::path& path) {
  std::error_code no_such_file;
  std::ifstream file;
  // A FIFO would block when it is opened.
  if (std::filesystem::is_regular_file(path, no_such_file)) {
    file.open(path);
  }
  if (!file.is_open()) {
    throw InputError(path.string(), "cannot be read; is the path right, and is it a URDF file?");
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

urdf::ModelInterfaceSharedPtr parseUrdf(const std::filesystem::path& path) {
  const std::string text = readFile(path);
  static std::mutex mutex;  // console_bridge has one output handler for the whole process
  const std::lock_guard<std::mutex> lock(mutex);
  const ParserLog log;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(text);
    reason = log.errors();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!model || !reason.empty()) {
    throw InputError(path.string(),
                     "is not a valid URDF: " + (reason.empty() ? "no reason given" : reason));
  }
  return model;
}

}  // namespace casepush
