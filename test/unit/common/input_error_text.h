#pragma once

#include <string>

#include "casepush/common/input_error.h"

namespace casepush {

/// Message of the InputError that `action` throws; empty if it throws none.
template <typename Action>
std::string inputErrorText(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace casepush
