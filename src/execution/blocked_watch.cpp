#include "blocked_watch.h"

#include <cmath>

namespace casepush {
namespace {

constexpr double kWindowS = 0.16;
// It must be so for three ticks at 50 Hz: single poses are off by millimetres.
constexpr double kHoldS = 0.035;
// The first command may take long to reach a base, so that a start counts only after this.
constexpr double kStartS = 1.0;
constexpr double kTimeSlackS = 1e-6;
// Time without observations after which nothing is known of what the robot did.
constexpr double kGapS = 0.1;
// A base follows its commands some 0.1 s late: in the first fifth of a second of a start it does a
// third of what it is told, and where it turns back it stands while up to 2 cm are commanded.
constexpr double kLeastShare = 0.15;
constexpr double kLeastCommandedM = 0.02;
// A free robot may be off by this share of its way and so much for its lag. In the simulator it was
// off by 15 % at most, and a robot that slides along a wall at 45 degrees by 70 %.
constexpr double kFreeShare = 0.5;
constexpr double kFreeM = 0.01;
// Travel that a turn by one radian counts as: the outside of a robot.
constexpr double kMetresPerRad = 0.3;

double travel(const Pose2& from, const Pose2& to) {
  return distance(from, to) + kMetresPerRad * std::abs(yawDifference(from, to));
}

}  // namespace

bool BlockedWatch::isBlocked(const Observation& observation, const Twist2& commanded, Drive drive) {
  // By the pose's own time: one that comes late is no robot that stands.
  const double now_s = observation.robot_stamp_s;
  if (!past_.empty() && now_s == past_.back().stamp_s) {
    return false;
  }
  if (!past_.empty() && (now_s < past_.back().stamp_s || now_s - past_.back().stamp_s > kGapS)) {
    reset();
  }
  Sample now{now_s, observation.map_T_robot, Pose2()};
  if (!past_.empty()) {
    const Eigen::Vector3d rate(commanded.vx_mps, commanded.vy_mps, commanded.wz_rps);
    now.commanded = past_.back().commanded * expSe2((now_s - past_.back().stamp_s) * rate);
  }
  past_.push_back(now);
  while (past_.size() > 1 && now_s - past_[1].stamp_s >= kWindowS - kTimeSlackS) {
    past_.pop_front();
  }
  const Motion motion = lastMotion(drive);
  if (motion != Motion::kHeld) {
    follows_ = motion == Motion::kFollows;
    held_since_s_.reset();
    return false;
  }
  held_since_s_ = held_since_s_.value_or(now_s);
  return now_s - *held_since_s_ >= (follows_ ? kHoldS : kStartS);
}

void BlockedWatch::reset() {
  past_.clear();
  held_since_s_.reset();
  follows_ = false;
}

BlockedWatch::Motion BlockedWatch::lastMotion(Drive drive) const {
  const Sample& then = past_.front();
  const Sample& now = past_.back();
  if (now.stamp_s - then.stamp_s < kWindowS - kTimeSlackS) {
    return Motion::kUnknown;
  }
  const double commanded_m = travel(then.commanded, now.commanded);
  if (commanded_m <= kLeastCommandedM) {
    return Motion::kUnknown;
  }
  const Pose2 moved = then.map_T_robot.inverse() * now.map_T_robot;
  const bool is_held = drive == Drive::kPushing ? travel(Pose2(), moved) < kLeastShare * commanded_m
                                                : travel(then.commanded.inverse() * now.commanded,
                                                         moved) > kFreeShare * commanded_m + kFreeM;
  return is_held ? Motion::kHeld : Motion::kFollows;
}

}  // namespace casepush
