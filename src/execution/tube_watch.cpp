#include "tube_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "casepush/cases/case_tube.h"

namespace casepush {

TubeWatch::TubeWatch(const Case& push_case, const TubeWatchOptions& options)
    : options_(options),
      period_s_(push_case.period_s),
      count_(push_case.effective_count),
      tube_(push_case.tube.empty()
                ? tubeFromOutcome(push_case.steps, push_case.start_outcome, CovarianceFloor{})
                : push_case.tube) {}

bool TubeWatch::isOutside(double push_time_s, const Pose2& start_T_object) {
  const auto stepAt = [this](double t_s) {
    const double last = static_cast<double>(tube_.size() - 1);
    return static_cast<std::size_t>(std::clamp(std::round(t_s / period_s_), 0.0, last));
  };
  const std::size_t last = stepAt(push_time_s + options_.slack_s);
  p_value_ = 0.0;
  for (std::size_t i = stepAt(push_time_s - options_.slack_s); i <= last; ++i) {
    const double off_m = distance(tube_[i].mean, start_T_object);
    const double off_rad = std::abs(yawDifference(tube_[i].mean, start_T_object));
    if (off_m <= options_.least_m && off_rad <= options_.least_rad) {
      return false;
    }
    const double p_value =
        testPrediction({tube_[i], count_}, start_T_object, options_.alpha).p_value;
    if (p_value >= p_value_) {
      p_value_ = p_value;
      off_m_ = off_m;
      off_rad_ = off_rad;
    }
  }
  return p_value_ < options_.alpha;
}

bool TubeWatch::hasLeft(double push_time_s, double stamp_s, const Pose2& start_T_object) {
  if (!last_stamp_s_ || stamp_s > *last_stamp_s_) {
    last_stamp_s_ = stamp_s;
    if (!isOutside(push_time_s, start_T_object)) {
      outside_since_s_.reset();
    } else if (!outside_since_s_) {
      outside_since_s_ = stamp_s;
    }
  }
  return outside_since_s_ && stamp_s - *outside_since_s_ >= options_.hold_s;
}

std::string TubeWatch::describe() const {
  char text[64];
  std::snprintf(text, sizeof(text), "%.0f cm and %.0f deg off its course", 100.0 * off_m_,
                off_rad_ * 180.0 / M_PI);
  return text;
}

}  // namespace casepush
