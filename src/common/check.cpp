#include "casepush/common/check.h"

#include <cstdlib>
#include <iostream>

namespace casepush {

void reportFailedCheck(const char* condition, const char* file, int line,
                       const std::string& values) {
  std::cerr << "casepush: internal check failed: " << condition << " (" << values << ") at " << file
            << ":" << line << ". This is a bug; please report it with this line." << std::endl;
  std::abort();
}

}  // namespace casepush
