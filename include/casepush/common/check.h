#pragma once

#include <sstream>

namespace casepush {

/// Ends the program with the message: a check that fails is a bug in casepush.
[[noreturn]] void reportFailedCheck(const char* condition, const char* file, int line,
                                    const std::string& values);

}  // namespace casepush

/// Always on. `values` is a stream expression that prints what led to the failure.
#define CASEPUSH_CHECK(condition, values)                                                         \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      std::ostringstream casepush_check_stream;                                                   \
      casepush_check_stream << values;                                                            \
      ::casepush::reportFailedCheck(#condition, __FILE__, __LINE__, casepush_check_stream.str()); \
    }                                                                                             \
  } while (false)
