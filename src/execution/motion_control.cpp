#include "motion_control.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kMaxFeedbackMps = 0.25;
constexpr double kMaxFeedbackRps = 0.5;

Eigen::Vector2d shortened(const Eigen::Vector2d& v, double max_norm) {
  const double norm = v.norm();
  return norm > max_norm ? Eigen::Vector2d(v * (max_norm / norm)) : v;
}

}  // namespace

Twist2 CommandLimiter::limit(const Twist2& wanted, double dt_s) {
  const Eigen::Vector2d target = shortened({wanted.vx_mps, wanted.vy_mps}, limits_.max_speed_mps);
  const double target_wz =
      std::clamp(wanted.wz_rps, -limits_.max_yaw_rate_rps, limits_.max_yaw_rate_rps);
  // In a turning frame a steady motion needs no acceleration.
  const Twist2 steady = rotate(last_, -last_.wz_rps * dt_s);
  const Eigen::Vector2d last(steady.vx_mps, steady.vy_mps);
  const Eigen::Vector2d next =
      last + shortened(target - last, limits_.max_acceleration_mps2 * dt_s);
  const double max_turn = limits_.max_yaw_acceleration_rps2 * dt_s;
  const double next_wz = last_.wz_rps + std::clamp(target_wz - last_.wz_rps, -max_turn, max_turn);
  last_ = {next.x(), next.y(), next_wz};
  return last_;
}

Twist2 track(const Pose2& map_T_robot, const Reference& reference, const TrackingGains& gains) {
  const Pose2 robot_T_reference = map_T_robot.inverse() * reference.map_T_reference;
  const Twist2 forward = rotate(reference.action, robot_T_reference.yaw());
  const Eigen::Vector2d feedback =
      shortened(gains.position_per_s * robot_T_reference.position(), kMaxFeedbackMps);
  const double turn =
      std::clamp(gains.yaw_per_s * robot_T_reference.yaw(), -kMaxFeedbackRps, kMaxFeedbackRps);
  return {forward.vx_mps + feedback.x(), forward.vy_mps + feedback.y(), forward.wz_rps + turn};
}

}  // namespace casepush
