#pragma once

#include <cstdint>

#include "casepush/common/pose2.h"
#include "casepush/common/random.h"
#include "casepush/sim/simulator.h"

namespace casepush::sim {

/// Wheel odometry that drifts and a localisation that corrects it, up to a bounded error which
/// wanders slowly (an Ornstein-Uhlenbeck process).
class Localisation {
 public:
  Localisation(const SimulatorOptions& options, const Pose2& map_T_robot);

  /// After each step.
  void update(double step_s, const Pose2& map_T_robot, const Twist2& robot_twist);

  /// The robot was put somewhere else: odometry does not notice, localisation does.
  void relocate(const Pose2& map_T_robot);

  OdometryReading reading(double time_s) const;

 private:
  bool noise_;
  double sigma_m_;
  double sigma_rad_;
  double correlation_s_;
  Random random_;
  double scale_ = 1.0;                               // Of the wheels' odometry.
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();  // Tangent at the robot's pose.
  Pose2 map_T_robot_;
  Pose2 odom_T_robot_;
  Twist2 robot_twist_;
};

}  // namespace casepush::sim
