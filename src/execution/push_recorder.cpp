#include "push_recorder.h"

#include <algorithm>

#include "casepush/cases/outcome_statistics.h"

namespace casepush {
namespace {

constexpr double kTimeSlackS = 1e-6;

}  // namespace

PushRecorder::PushRecorder(double period_s, const Pose2& map_T_start)
    : period_s_(period_s), map_T_start_(map_T_start), latest_{-1.0, {}, {}, {}} {}

void PushRecorder::add(double t_s, const Pose2& map_T_robot, const Pose2& map_T_object,
                       const Twist2& action) {
  const Sample now{t_s, map_T_robot, map_T_object, action};
  const Sample before = latest_.t_s < 0.0 ? now : latest_;
  for (double due_s = period_s_ * static_cast<double>(samples_.size()); due_s <= t_s + kTimeSlackS;
       due_s = period_s_ * static_cast<double>(samples_.size())) {
    const double span_s = t_s - before.t_s;
    const double share = span_s > 0.0 ? std::clamp((due_s - before.t_s) / span_s, 0.0, 1.0) : 1.0;
    samples_.push_back({due_s, interpolate(before.map_T_robot, map_T_robot, share),
                        interpolate(before.map_T_object, map_T_object, share), action});
  }
  latest_ = now;
}

void PushRecorder::endPush() { push_samples_ = static_cast<int>(samples_.size()); }

Case PushRecorder::finish(double rest_from_s, const Pose2& map_T_end) const {
  const Pose2 start_T_map = map_T_start_.inverse();
  Case recorded;
  recorded.period_s = period_s_;
  recorded.push_steps = push_samples_ > 0 ? push_samples_ : static_cast<int>(samples_.size());
  for (const Sample& sample : samples_) {
    const int count = static_cast<int>(recorded.steps.size());
    if (count > recorded.push_steps && sample.t_s > rest_from_s) {
      break;
    }
    recorded.steps.push_back({sample.map_T_object.inverse() * sample.map_T_robot, sample.action,
                              start_T_map * sample.map_T_object});
  }
  const Pose2 start_T_end = start_T_map * map_T_end;
  // One more sample than those of the push, so that the last one is at rest and none of its.
  recorded.steps.push_back({map_T_end.inverse() * latest_.map_T_robot, Twist2{}, start_T_end});
  const CovarianceFloor floor;
  const OutcomeStatistics first = addObservation(OutcomeStatistics{}, start_T_end, floor);
  recorded.start_outcome = first.start_outcome;
  recorded.effective_count = first.effective_count;
  recorded.observation_count = 1;
  return recorded;
}

}  // namespace casepush
