#include "casepush/planning/push_time.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

// Distance of the origin from the segment a-b.
double distanceFromOrigin(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0.0 ? std::clamp(-a.dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + t * along).norm();
}

}  // namespace

PushTime::PushTime(const std::vector<PreparedCase>& cases, const PushTimeOptions& options)
    : options_(options), count_(cases.size()) {
  for (const PreparedCase& push_case : cases) {
    begin_.push_back(push_case.robot_begin);
    duration_s_.push_back(push_case.duration_s);
  }
  for (const PreparedCase& push_case : cases) {
    end_.push_back(push_case.outcome_T_robot);
    // Any push needs its handling, and may need no way at all.
    const double fastest_s = options_.handling_s + push_case.duration_s;
    best_speed_mps_ =
        std::max(best_speed_mps_, push_case.start_outcome.mean.position().norm() / fastest_s);
  }
  if (count_ > kTabled) return;
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t j = 0; j < count_; ++j) {
      step_s_.push_back(drive(end_[i], begin_[j]) + duration_s_[j]);
    }
  }
}

// Straight on if the object is not in the way, otherwise out, around it and in again.
double PushTime::drive(const Pose2& object_T_from, const Pose2& object_T_to) const {
  const Eigen::Vector2d from = object_T_from.position();
  const Eigen::Vector2d to = object_T_to.position();
  const double inner = std::min(from.norm(), to.norm());
  double length_m = (to - from).norm();
  if (distanceFromOrigin(from, to) < 0.95 * inner) {
    const double radius = inner + options_.clearance_m;
    const double turn =
        std::abs(wrapAngle(std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x())));
    length_m = std::abs(radius - from.norm()) + radius * turn + std::abs(radius - to.norm());
  }
  const double turning_s =
      std::abs(yawDifference(object_T_from, object_T_to)) / options_.turn_rate_rps;
  return options_.handling_s + std::max(length_m / options_.drive_speed_mps, turning_s);
}

double PushTime::first(const Pose2& object_T_robot, int next) const {
  return drive(object_T_robot, begin_[next]) + duration_s_[next];
}

double PushTime::first(const Pose2& object_T_robot, int next, double drive_m) const {
  return std::max(first(object_T_robot, next),
                  options_.handling_s + driveS(drive_m) + duration_s_[next]);
}

}  // namespace casepush
