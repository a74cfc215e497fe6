#include "violations.h"

#include "casepush/common/input_error.h"

namespace casepush {

void Violations::require(const char* key, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    text_ << (text_.tellp() > 0 ? "; " : "") << key << " is " << value << ", must be in [" << low
          << ", " << high << "]";
  }
}

void Violations::throwIfAny(const std::string& where) const {
  if (!text_.str().empty()) {
    throw InputError(where, text_.str());
  }
}

}  // namespace casepush
