#pragma once

#include <stdexcept>
#include <string>

namespace casepush {

/// Something given from outside (file, parameter, request) is wrong.
///
/// The message is one line for a person: where ("office.yaml: floor.friction"), what ("is -1"), and
/// the bound or the remedy ("must be in [0, 2]").
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& where, const std::string& what)
      : std::runtime_error(where + ": " + what) {}
};

}  // namespace casepush
