#pragma once

#include <sstream>
#include <string>

namespace casepush {

/// Collects what is wrong with a struct of options, to be told in one message.
class Violations {
 public:
  /// Notes a violation unless low <= value <= high; `high` may be infinite.
  void require(const char* key, double value, double low, double high);

  /// Notes a violation unless 0 < value <= high; `high` may be infinite.
  void requirePositive(const char* key, double value, double high);

  /// @throws InputError if anything was noted.
  void throwIfAny(const std::string& where) const;

 private:
  void add(const char* key, double value, const std::string& bound);

  std::ostringstream text_;
};

}  // namespace casepush
