#include "casepush/common/violations.h"

#include <cmath>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

}  // namespace

void Violations::require(const char* key, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  add(key, value,
      std::isinf(high) ? "at least " + text(low) : "in [" + text(low) + ", " + text(high) + "]");
}

void Violations::requirePositive(const char* key, double value, double high) {
  if (std::isfinite(value) && value > 0.0 && value <= high) return;
  add(key, value, std::isinf(high) ? "positive" : "in (0, " + text(high) + "]");
}

void Violations::add(const char* key, double value, const std::string& bound) {
  text_ << (text_.tellp() > 0 ? "; " : "") << key << " is " << value << ", must be " << bound;
}

void Violations::throwIfAny(const std::string& where) const {
  if (!text_.str().empty()) throw InputError(where, text_.str());
}

}  // namespace casepush
