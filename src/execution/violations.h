#pragma once

#include <sstream>
#include <string>

namespace casepush {

/// Collects what is wrong with a struct of options, to be told in one message.
class Violations {
 public:
  /// Notes a violation unless low <= value <= high.
  void require(const char* key, double value, double low, double high);

  /// @throws InputError if anything was noted.
  void throwIfAny(const std::string& where) const;

 private:
  std::ostringstream text_;
};

}  // namespace casepush
