#pragma once

#include <cstdint>

#include "casepush/common/pose2.h"
#include "casepush/common/random.h"
#include "casepush/model/robot_model.h"
#include "casepush/sim/simulator.h"
#include "odometry.h"

namespace casepush::sim {

/// An error that wanders slowly (an Ornstein-Uhlenbeck process), cut off at hard bounds.
class PoseError {
 public:
  /// Starts with a draw from the stationary law.
  PoseError(const LocalisationModel& model, bool noise, Random random);

  void update(double step_s);

  /// x and y along the map's axes [m], yaw [rad].
  Eigen::Vector3d value() const;

 private:
  LocalisationModel model_;
  bool noise_;
  Random random_;
  Eigen::Vector3d sigma_;
  Eigen::Vector3d wandering_ = Eigen::Vector3d::Zero();  // Before it is cut off.
};

/// Wheel odometry that drifts and a localisation that corrects it, up to a bounded error.
class Localisation {
 public:
  Localisation(const RobotModel& robot, bool noise, std::uint64_t seed, const Pose2& map_T_robot);

  /// After each step.
  void update(double step_s, const Pose2& map_T_robot, const Twist2& robot_twist);

  /// The robot was put somewhere else: odometry does not notice, localisation does.
  void relocate(const Pose2& map_T_robot);

  OdometryReading reading(double time_s) const;

 private:
  Odometry odometry_;
  PoseError error_;
  Pose2 map_T_robot_;
};

}  // namespace casepush::sim
