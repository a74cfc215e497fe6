#include "localisation.h"

#include <algorithm>
#include <cmath>

#include "sensor_timing.h"

namespace casepush::sim {

PoseError::PoseError(const LocalisationModel& model, bool noise, Random random)
    : model_(model),
      noise_(noise && model.switches.noise),
      random_(random),
      sigma_(model.position_sigma_m, model.position_sigma_m, model.yaw_sigma_rad) {
  if (!noise_) return;
  for (int i = 0; i < 3; ++i) wandering_[i] = random_.normal(sigma_[i]);
}

void PoseError::update(double step_s) {
  if (!noise_) return;
  const double decay = std::exp(-step_s / model_.correlation_s);
  const double gain = std::sqrt(-std::expm1(-2.0 * step_s / model_.correlation_s));
  for (int i = 0; i < 3; ++i) {
    wandering_[i] = decay * wandering_[i] + gain * random_.normal(sigma_[i]);
  }
}

Eigen::Vector3d PoseError::value() const {
  Eigen::Vector3d error = wandering_;
  const double length_m = error.head<2>().norm();
  if (length_m > model_.position_bound_m) error.head<2>() *= model_.position_bound_m / length_m;
  error.z() = std::clamp(error.z(), -model_.yaw_bound_rad, model_.yaw_bound_rad);
  return error;
}

Localisation::Localisation(const RobotModel& robot, bool noise, std::uint64_t seed,
                           const Pose2& map_T_robot)
    : odometry_(robot.odometry, noise, noiseStream(robot.odometry.switches, seed, "odometry")),
      error_(robot.localisation, noise,
             noiseStream(robot.localisation.switches, seed, "localisation")),
      map_T_robot_(map_T_robot) {}

void Localisation::update(double step_s, const Pose2& map_T_robot, const Twist2& robot_twist) {
  odometry_.update(step_s, logSe2(map_T_robot_.inverse() * map_T_robot), robot_twist);
  error_.update(step_s);
  map_T_robot_ = map_T_robot;
}

void Localisation::relocate(const Pose2& map_T_robot) {
  map_T_robot_ = map_T_robot;
  odometry_.stop();
}

OdometryReading Localisation::reading(double time_s) const {
  const Eigen::Vector3d error = error_.value();
  const Pose2 map_T_estimated_robot(map_T_robot_.x() + error.x(), map_T_robot_.y() + error.y(),
                                    map_T_robot_.yaw() + error.z());
  const Pose2& odom_T_robot = odometry_.odom_T_robot();
  return {time_s, map_T_estimated_robot * odom_T_robot.inverse(), odom_T_robot, odometry_.twist()};
}

}  // namespace casepush::sim
