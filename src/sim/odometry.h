#pragma once

#include "casepush/common/pose2.h"
#include "casepush/common/random.h"
#include "casepush/model/sensors.h"

namespace casepush::sim {

/// Wheel odometry: measures velocities that are off by a factor and by noise, and integrates them.
class Odometry {
 public:
  Odometry(const OdometryModel& model, bool noise, Random random);

  /// @param moved  What the robot moved by during a step, as a tangent in its own frame.
  /// @param twist  Its velocity at the end of the step.
  void update(double step_s, const Eigen::Vector3d& moved, const Twist2& twist);

  /// The robot was put somewhere else, at rest: wheels do not notice.
  void stop() { twist_ = {}; }

  const Pose2& odom_T_robot() const { return odom_T_robot_; }
  const Twist2& twist() const { return twist_; }

 private:
  Eigen::Vector3d velocityNoise(double step_s, const Eigen::Vector3d& velocity);

  OdometryModel model_;
  bool noise_;
  Random random_;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Ones();
  Eigen::Vector3d draw_ = Eigen::Vector3d::Zero();  // Standard normal, held for some steps.
  int steps_ = 0;
  Pose2 odom_T_robot_;
  Twist2 twist_;
};

}  // namespace casepush::sim
