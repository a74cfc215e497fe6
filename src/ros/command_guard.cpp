#include "casepush/ros/command_guard.h"

#include <cmath>

namespace casepush {
namespace {

constexpr double kLimitSlack = 1.02;  // For rounding.

}  // namespace

CommandGuard::Verdict CommandGuard::judge(const Twist2& wanted, double robot_age_s,
                                          double objects_age_s) const {
  // Written so that NaN counts as stale.
  if (!(robot_age_s <= stale_robot_s_)) {
    return {Twist2{}, "the robot's pose is stale"};
  }
  if (!(objects_age_s <= stale_objects_s_)) {
    return {Twist2{}, "the objects' poses are stale"};
  }
  if (!wanted.isFinite()) {
    return {Twist2{}, "a command is not finite"};
  }
  if (wanted.speed() > limits_.max_speed_mps * kLimitSlack ||
      std::abs(wanted.wz_rps) > limits_.max_yaw_rate_rps * kLimitSlack) {
    return {Twist2{}, "a command is beyond the robot's limits"};
  }
  return {wanted, ""};
}

}  // namespace casepush
