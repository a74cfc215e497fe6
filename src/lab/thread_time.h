#pragma once

#include <ctime>

namespace casepush {

/// CPU time of the calling thread: what a measurement needs on a machine with other work [s].
inline double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace casepush
