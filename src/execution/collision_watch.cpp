#include "collision_watch.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace casepush {
namespace {

// An object that is off its course by no more than the scatter of what is seen of it is on it.
constexpr double kOnCourse_m = 0.02;
constexpr double kOnCourse_rad = 0.07;
// Objects set off now earlier, now later, and a load slows them down.
constexpr double kEarly_s = 0.3;
constexpr double kLate_s = 0.6;
// How far ahead: what takes longer can still be seen later.
constexpr double kAhead_s = 1.0;

double offCourse(const Pose2& course, const Pose2& seen) {
  return std::hypot(distance(course, seen) / kOnCourse_m,
                    yawDifference(course, seen) / kOnCourse_rad);
}

std::vector<Pose2> meanCourse(const Case& push_case) {
  std::vector<Pose2> course;
  for (const PoseGaussian& at : push_case.tube) course.push_back(at.mean);
  if (course.empty()) {
    for (const CaseStep& step : push_case.steps) course.push_back(step.start_T_object);
  }
  return course;
}

}  // namespace

CollisionWatch::CollisionWatch(const Case& push_case, TouchCheck check)
    : check_(std::move(check)), period_s_(push_case.period_s), course_(meanCourse(push_case)) {}

void CollisionWatch::begin(const Observation& observation, const Pose2& map_T_start) {
  map_T_start_ = map_T_start;
  const auto free = std::find_if(course_.begin(), course_.end(), [&](const Pose2& at) {
    return check_(observation, {map_T_start * at}).empty();
  });
  watched_from_ = static_cast<std::size_t>(free - course_.begin());
}

// The step of the course that fits best tells how far the object has come.
std::vector<Pose2> CollisionWatch::courseFrom(const Pose2& start_T_object,
                                              double push_time_s) const {
  const auto stepAt = [this](double t_s) {
    const double last = static_cast<double>(course_.size() - 1);
    return course_.begin() + static_cast<int>(std::clamp(std::round(t_s / period_s_), 0.0, last));
  };
  const auto nearer = [&](const Pose2& a, const Pose2& b) {
    return offCourse(a, start_T_object) < offCourse(b, start_T_object);
  };
  const auto now = std::min_element(stepAt(push_time_s - kLate_s),
                                    std::next(stepAt(push_time_s + kEarly_s)), nearer);
  const bool is_on_course = offCourse(*now, start_T_object) <= 1.0;
  const Pose2 map_T_course =
      is_on_course ? map_T_start_ : map_T_start_ * start_T_object * now->inverse();
  const auto first = std::max(now, course_.begin() + static_cast<std::ptrdiff_t>(watched_from_));
  const auto end = std::next(stepAt(period_s_ * std::distance(course_.begin(), now) + kAhead_s));
  std::vector<Pose2> ahead;
  for (auto at = first; at < end; ++at) ahead.push_back(map_T_course * *at);
  return ahead;
}

const std::string& CollisionWatch::aheadOf(const Observation& observation, double push_time_s,
                                           const ObjectState& object) {
  const bool is_new = !last_stamp_s_ || object.stamp_s > *last_stamp_s_;
  if (!is_new) return ahead_of_;
  last_stamp_s_ = object.stamp_s;
  const Pose2 start_T_object = map_T_start_.inverse() * object.map_T_object;
  const std::string touched = check_(observation, courseFrom(start_T_object, push_time_s));
  if (!touched.empty() && seen_once_) ahead_of_ = touched;
  seen_once_ = !touched.empty();
  return ahead_of_;
}

}  // namespace casepush
