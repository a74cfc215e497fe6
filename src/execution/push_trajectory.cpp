#include <algorithm>
#include <cmath>

#include "casepush/common/violations.h"
#include "casepush/execution/execute_push.h"
#include "casepush/model/motion_direction.h"

namespace casepush {
namespace {

constexpr double kLongestS = 60.0;

struct Position {
  std::size_t index;
  double fraction;
};

Position positionAt(const PushTrajectory& trajectory, double t_s) {
  const double last = static_cast<double>(trajectory.start_T_robot.size() - 1);
  const double place = std::clamp(t_s / trajectory.period_s, 0.0, last);
  const auto index = static_cast<std::size_t>(place);
  return {index, place - static_cast<double>(index)};
}

/// Integral over [0, t] of a trapezoid that rises at `rate` to 1 and is 0 again at `duration`.
double trapezoidArea(double t, double rate, double duration) {
  const double ramp = std::min(1.0 / rate, 0.5 * duration);
  const double peak = rate * ramp;
  const double rise = std::min(t, ramp);
  const double level = std::clamp(t - ramp, 0.0, duration - 2.0 * ramp);
  const double fall = std::clamp(t - (duration - ramp), 0.0, ramp);
  return 0.5 * rate * rise * rise + peak * level + peak * fall - 0.5 * rate * fall * fall;
}

double trapezoidHeight(double t, double rate, double duration) {
  return std::max(0.0, std::min({1.0, rate * t, rate * (duration - t)}));
}

void validate(const PushConfiguration& configuration, const RobotLimits& limits, double period_s) {
  Violations violations;
  const Pose2& start = configuration.object_T_robot;
  violations.require("object_T_robot.x", start.x(), -100.0, 100.0);
  violations.require("object_T_robot.y", start.y(), -100.0, 100.0);
  violations.require("object_T_robot.yaw", start.yaw(), -M_PI, M_PI);
  violations.require("direction_rad", configuration.direction_rad, -2.0 * M_PI, 2.0 * M_PI);
  violations.requirePositive("speed_mps", configuration.speed_mps, limits.max_speed_mps);
  violations.require("yaw_rate_rps", configuration.yaw_rate_rps, -limits.max_yaw_rate_rps,
                     limits.max_yaw_rate_rps);
  violations.requirePositive("duration_s", configuration.duration_s, kLongestS);
  violations.require("period_s", period_s, 1e-3, 10.0);
  violations.throwIfAny("push configuration");
}

}  // namespace

double PushTrajectory::durationS() const {
  return period_s * static_cast<double>(start_T_robot.size() - 1);
}

Pose2 PushTrajectory::poseAt(double t_s) const {
  const Position at = positionAt(*this, t_s);
  const std::size_t next = std::min(at.index + 1, start_T_robot.size() - 1);
  return interpolate(start_T_robot[at.index], start_T_robot[next], at.fraction);
}

Twist2 PushTrajectory::actionAt(double t_s) const {
  const Position at = positionAt(*this, t_s);
  const Twist2& a = action[at.index];
  const Twist2& b = action[std::min(at.index + 1, action.size() - 1)];
  const auto mix = [&at](double from, double to) { return from + at.fraction * (to - from); };
  return {mix(a.vx_mps, b.vx_mps), mix(a.vy_mps, b.vy_mps), mix(a.wz_rps, b.wz_rps)};
}

double PushTrajectory::startDirectionRad() const {
  if (const std::optional<double> direction = motionDirection(start_T_robot)) return *direction;
  const Eigen::Vector2d motion = start_T_robot.back().position() - start_T_robot.front().position();
  return motion.norm() > 1e-6 ? std::atan2(motion.y(), motion.x()) : start_T_robot.front().yaw();
}

PushTrajectory pushTrajectory(const PushConfiguration& configuration, const RobotLimits& limits,
                              double period_s) {
  validate(configuration, limits, period_s);
  const Twist2 full{configuration.speed_mps * std::cos(configuration.direction_rad),
                    configuration.speed_mps * std::sin(configuration.direction_rad),
                    configuration.yaw_rate_rps};
  const double turn = std::max(std::abs(full.wz_rps), 1e-9);
  const double rate = std::min(limits.max_acceleration_mps2 / configuration.speed_mps,
                               limits.max_yaw_acceleration_rps2 / turn);
  const int count =
      std::max(1, static_cast<int>(std::lround(configuration.duration_s / period_s))) + 1;
  const double duration_s = period_s * (count - 1);
  PushTrajectory trajectory;
  trajectory.period_s = period_s;
  for (int i = 0; i < count; ++i) {
    const double t_s = period_s * i;
    const double area_s = trapezoidArea(t_s, rate, duration_s);
    const double height = trapezoidHeight(t_s, rate, duration_s);
    trajectory.start_T_robot.push_back(
        configuration.object_T_robot *
        expSe2(area_s * Eigen::Vector3d(full.vx_mps, full.vy_mps, full.wz_rps)));
    trajectory.action.push_back({height * full.vx_mps, height * full.vy_mps, height * full.wz_rps});
  }
  return trajectory;
}

PushTrajectory pushTrajectory(const Case& push_case) {
  validateCase(push_case, "case " + std::to_string(push_case.id));
  std::vector<Pose2> raw;
  for (int i = 0; i < push_case.push_steps; ++i) {
    raw.push_back(push_case.steps[i].start_T_robot());
  }
  PushTrajectory trajectory;
  trajectory.period_s = push_case.period_s;
  const int last = push_case.push_steps - 1;
  for (int i = 0; i <= last; ++i) {
    const int before = std::max(0, i - 1);
    const int after = std::min(last, i + 1);
    const bool is_end = i == 0 || i == last;
    const Pose2 middle = interpolate(raw[before], raw[after], 0.5);
    trajectory.start_T_robot.push_back(is_end ? raw[i] : interpolate(raw[i], middle, 0.5));
    const Twist2& a = push_case.steps[before].action;
    const Twist2& b = push_case.steps[i].action;
    const Twist2& c = push_case.steps[after].action;
    trajectory.action.push_back({0.25 * a.vx_mps + 0.5 * b.vx_mps + 0.25 * c.vx_mps,
                                 0.25 * a.vy_mps + 0.5 * b.vy_mps + 0.25 * c.vy_mps,
                                 0.25 * a.wz_rps + 0.5 * b.wz_rps + 0.25 * c.wz_rps});
  }
  return trajectory;
}

}  // namespace casepush
