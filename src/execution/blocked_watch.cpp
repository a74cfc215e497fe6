#include "blocked_watch.h"

#include <cmath>

namespace casepush {
namespace {

constexpr double kWindowS = 0.2;
// Time without observations after which nothing is known of what the robot did.
constexpr double kGapS = 0.1;
// A base follows its commands some 0.1 s late: in the first fifth of a second of a start it does a
// third of what it is told.
constexpr double kLeastShare = 0.15;
constexpr double kLeastCommandedM = 0.02;
// Travel that a turn by one radian counts as: the outside of a robot.
constexpr double kMetresPerRad = 0.3;

}  // namespace

bool BlockedWatch::isBlocked(const Observation& observation, const Twist2& commanded) {
  const double now_s = observation.stamp_s;
  if (!past_.empty() && (now_s < past_.back().stamp_s || now_s - past_.back().stamp_s > kGapS)) {
    reset();
  }
  Sample now{now_s, observation.map_T_robot, 0.0};
  if (!past_.empty()) {
    const double rate = commanded.speed() + kMetresPerRad * std::abs(commanded.wz_rps);
    now.commanded_m = past_.back().commanded_m + rate * (now_s - past_.back().stamp_s);
  }
  past_.push_back(now);
  while (past_.size() > 1 && now_s - past_[1].stamp_s >= kWindowS) {
    past_.pop_front();
  }
  const Sample& then = past_.front();
  if (now_s - then.stamp_s < kWindowS) {
    return false;
  }
  const double commanded_m = now.commanded_m - then.commanded_m;
  const double moved_m = distance(then.map_T_robot, now.map_T_robot) +
                         kMetresPerRad * std::abs(yawDifference(then.map_T_robot, now.map_T_robot));
  return commanded_m > kLeastCommandedM && moved_m < kLeastShare * commanded_m;
}

}  // namespace casepush
