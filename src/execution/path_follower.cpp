#include "path_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"
#include "rounded_path.h"

namespace casepush {
namespace {

constexpr double kLongestDockM = 0.3;
// How far corners are cut, and the velocity step that the base takes at those that are not: either
// leaves room to stay within 2.5 cm of the path that was checked.
constexpr double kCutM = 0.015;
constexpr double kEndCutM = 0.005;  // Beside an object.
constexpr double kCornerStepMps = 0.15;
constexpr double kCornerStepRps = 0.4;
// Along the path, and towards the centre of an arc. The rest of what the robot can do is left to
// feedback.
constexpr double kAccelerationShare = 0.85;
constexpr double kCentripetalShare = 0.5;
// Errors at which the reference slows down and at which it waits for the robot.
constexpr double kSlowErrorM = 0.05;
constexpr double kWaitErrorM = 0.12;
constexpr double kSlowErrorRad = 0.2;
constexpr double kWaitErrorRad = 0.5;
// Final creep, so that the reference arrives in finite time.
constexpr double kLeastSpeedMps = 0.02;

/// A segment between two waypoints, for each metre of its length in the follower's metric.
struct Course {
  Eigen::Vector2d travel;
  double turn_rad_per_m;
};

double mostAcceleration(const Course& course, const RobotLimits& limits) {
  const double turn = std::abs(course.turn_rad_per_m);
  return std::min(limits.max_acceleration_mps2 / std::max(course.travel.norm(), 1e-9),
                  limits.max_yaw_acceleration_rps2 / std::max(turn, 1e-9));
}

double stepSpeed(const Course& in, const Course& out) {
  const double step = (out.travel - in.travel).norm();
  const double turn = std::abs(out.turn_rad_per_m - in.turn_rad_per_m);
  return std::min(kCornerStepMps / std::max(step, 1e-9), kCornerStepRps / std::max(turn, 1e-9));
}

double share(double error, double slow, double wait) {
  return std::clamp((wait - error) / (wait - slow), 0.0, 1.0);
}

}  // namespace

PathFollower::PathFollower(std::vector<Pose2> waypoints, const RobotLimits& limits,
                           const Speeds& speeds)
    : speeds_(speeds) {
  CASEPUSH_CHECK(!waypoints.empty(), "path without waypoints");
  const CornerLimits corners{kCutM, kEndCutM, kCornerStepMps,
                             kCentripetalShare * limits.max_acceleration_mps2};
  RoundedPath rounded = roundCorners(waypoints, corners);
  waypoints_ = std::move(rounded.waypoints);
  speeds_.cruise_mps = std::min(speeds.cruise_mps, limits.max_speed_mps);
  speeds_.dock_mps = std::min(speeds.dock_mps, speeds_.cruise_mps);
  // Yaw that takes as long as a metre of travel.
  const double rad_per_m = limits.max_yaw_rate_rps / speeds_.cruise_mps;
  std::vector<Course> courses;
  reach_ = {0.0};
  for (std::size_t i = 1; i < waypoints_.size(); ++i) {
    const Eigen::Vector2d travel = waypoints_[i].position() - waypoints_[i - 1].position();
    const double turn = yawDifference(waypoints_[i - 1], waypoints_[i]);
    const double length = std::max(travel.norm(), std::abs(turn) / rad_per_m);
    const double scale = 1.0 / std::max(length, 1e-9);
    courses.push_back({scale * travel, scale * turn});
    acceleration_.push_back(kAccelerationShare * mostAcceleration(courses.back(), limits));
    reach_.push_back(reach_.back() + length);
  }
  corner_speed_ = {speeds_.cruise_mps};
  for (std::size_t i = 1; i + 1 < waypoints_.size(); ++i) {
    double speed = std::min(speeds_.cruise_mps, stepSpeed(courses[i - 1], courses[i]));
    if (rounded.radius_m[i] > 0.0) {
      speed = std::min(speed, std::sqrt(corners.acceleration_mps2 * rounded.radius_m[i]) /
                                  std::max(courses[i].travel.norm(), 1e-9));
    }
    corner_speed_.push_back(speed);
  }
  corner_speed_.push_back(0.0);
  if (waypoints_.size() > 1) {
    dock_length_ = std::min(kLongestDockM, total() - reach_[reach_.size() - 2]);
  }
  for (std::size_t i = waypoints_.size() - 1; i > 0; --i) {
    corner_speed_[i - 1] = std::min(corner_speed_[i - 1], speedBefore(i, reach_[i - 1]));
  }
}

std::size_t PathFollower::nextWaypoint() const {
  const auto next = std::upper_bound(reach_.begin() + 1, reach_.end() - 1, travelled_);
  return static_cast<std::size_t>(next - reach_.begin());
}

double PathFollower::speedBefore(std::size_t waypoint, double travelled) const {
  const auto braking = [&](double speed_there, double at) {
    return std::sqrt(speed_there * speed_there +
                     2.0 * acceleration_[waypoint - 1] * std::max(0.0, at - travelled));
  };
  const double speed =
      std::min(speeds_.cruise_mps, braking(corner_speed_[waypoint], reach_[waypoint]));
  if (waypoint + 1 < waypoints_.size()) return speed;
  return std::min(speed, braking(speeds_.dock_mps, total() - dock_length_));
}

Reference PathFollower::reference() const {
  if (waypoints_.size() == 1 || atEnd()) {
    return {waypoints_.back(), Twist2{}};
  }
  const std::size_t i = nextWaypoint();
  const Pose2& from = waypoints_[i - 1];
  const Pose2& to = waypoints_[i];
  const double length = std::max(reach_[i] - reach_[i - 1], 1e-9);
  const double t = std::clamp((travelled_ - reach_[i - 1]) / length, 0.0, 1.0);
  const double turn = yawDifference(from, to);
  // Straight, not the screw motion: the path planner checked straight lines.
  const Eigen::Vector2d travel = to.position() - from.position();
  const Eigen::Vector2d position = from.position() + t * travel;
  const Pose2 pose(position.x(), position.y(), from.yaw() + t * turn);
  const double rate = speed_ / length;
  const Twist2 in_map{rate * travel.x(), rate * travel.y(), rate * turn};
  return {pose, rotate(in_map, -pose.yaw())};
}

Reference PathFollower::advance(double dt_s, const Pose2& map_T_robot) {
  const Pose2 here = reference().map_T_reference;
  const double keeps_up =
      std::min(share(distance(map_T_robot, here), kSlowErrorM, kWaitErrorM),
               share(std::abs(yawDifference(map_T_robot, here)), kSlowErrorRad, kWaitErrorRad));
  if (waypoints_.size() > 1) {
    const std::size_t next = nextWaypoint();
    const double allowed = std::max(kLeastSpeedMps, speedBefore(next, travelled_));
    speed_ = std::min(speed_ + acceleration_[next - 1] * dt_s, keeps_up * allowed);
  }
  travelled_ = std::min(total(), travelled_ + speed_ * dt_s);
  return reference();
}

}  // namespace casepush
