#include "casepush/common/silence_timer.h"

#include <algorithm>

namespace casepush {
namespace {

constexpr double kLongestTickS = 0.2;

}  // namespace

double SilenceTimer::update(double now_s, bool is_missing) {
  const double dt_s = last_s_ ? std::clamp(now_s - *last_s_, 0.0, kLongestTickS) : 0.0;
  last_s_ = now_s;
  missing_s_ = is_missing && was_missing_ ? missing_s_ + dt_s : 0.0;
  was_missing_ = is_missing;
  return missing_s_;
}

void SilenceTimer::reset() { *this = SilenceTimer(); }

}  // namespace casepush
