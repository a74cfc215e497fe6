#include "path_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr double kLongestDockM = 0.3;
// Velocity step that the base takes at a corner: at 0.8 m/s^2 it leaves the path by some 2 cm.
constexpr double kCornerStepMps = 0.15;
// The rest of what the robot can do is left to feedback.
constexpr double kAccelerationShare = 0.7;
// Errors at which the reference slows down and at which it waits for the robot.
constexpr double kSlowErrorM = 0.05;
constexpr double kWaitErrorM = 0.12;
constexpr double kSlowErrorRad = 0.2;
constexpr double kWaitErrorRad = 0.5;
// Final creep, so that the reference arrives in finite time.
constexpr double kLeastSpeedMps = 0.02;

double cornerSpeed(const Pose2& before, const Pose2& corner, const Pose2& after,
                   double cruise_mps) {
  const Eigen::Vector2d in = corner.position() - before.position();
  const Eigen::Vector2d out = after.position() - corner.position();
  if (in.norm() < 1e-6 || out.norm() < 1e-6) {
    return std::min(cruise_mps, kCornerStepMps);
  }
  const double step = (out.normalized() - in.normalized()).norm();
  return std::min(cruise_mps, kCornerStepMps / std::max(step, 1e-9));
}

double share(double error, double slow, double wait) {
  return std::clamp((wait - error) / (wait - slow), 0.0, 1.0);
}

}  // namespace

PathFollower::PathFollower(std::vector<Pose2> waypoints, const RobotLimits& limits,
                           const Speeds& speeds)
    : limits_(limits), speeds_(speeds), waypoints_(std::move(waypoints)) {
  CASEPUSH_CHECK(!waypoints_.empty(), "path without waypoints");
  speeds_.cruise_mps = std::min(speeds.cruise_mps, limits.max_speed_mps);
  speeds_.dock_mps = std::min(speeds.dock_mps, speeds_.cruise_mps);
  // Yaw that takes as long as a metre of travel.
  const double rad_per_m = limits.max_yaw_rate_rps / speeds_.cruise_mps;
  acceleration_ = kAccelerationShare * std::min(limits.max_acceleration_mps2,
                                                limits.max_yaw_acceleration_rps2 / rad_per_m);
  reach_ = {0.0};
  for (std::size_t i = 1; i < waypoints_.size(); ++i) {
    const double turn = std::abs(yawDifference(waypoints_[i - 1], waypoints_[i]));
    const double travel = distance(waypoints_[i - 1], waypoints_[i]);
    reach_.push_back(reach_.back() + std::max(travel, turn / rad_per_m));
    const bool is_last = i + 1 == waypoints_.size();
    corner_speed_.push_back(is_last ? 0.0
                                    : cornerSpeed(waypoints_[i - 1], waypoints_[i],
                                                  waypoints_[i + 1], speeds_.cruise_mps));
  }
  corner_speed_.insert(corner_speed_.begin(), speeds_.cruise_mps);
  if (waypoints_.size() > 1) {
    dock_length_ = std::min(kLongestDockM, total() - reach_[reach_.size() - 2]);
  }
}

double PathFollower::allowedSpeed() const {
  double speed = docking() ? speeds_.dock_mps : speeds_.cruise_mps;
  const auto slowDown = [this, &speed](double at, double speed_there) {
    if (at >= travelled_) {
      speed = std::min(
          speed, std::sqrt(speed_there * speed_there + 2.0 * acceleration_ * (at - travelled_)));
    }
  };
  for (std::size_t i = 1; i < reach_.size(); ++i) {
    slowDown(reach_[i], corner_speed_[i]);
  }
  slowDown(total() - dock_length_, speeds_.dock_mps);
  return std::max(speed, kLeastSpeedMps);
}

Reference PathFollower::reference() const {
  if (waypoints_.size() == 1 || atEnd()) {
    return {waypoints_.back(), Twist2{}};
  }
  const auto next = std::upper_bound(reach_.begin() + 1, reach_.end() - 1, travelled_);
  const auto i = static_cast<std::size_t>(next - reach_.begin());
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
  speed_ = std::min(speed_ + acceleration_ * dt_s, keeps_up * allowedSpeed());
  travelled_ = std::min(total(), travelled_ + speed_ * dt_s);
  return reference();
}

}  // namespace casepush
