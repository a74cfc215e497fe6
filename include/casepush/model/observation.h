#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

/// A tracked object as everybody but the simulator sees it.
struct ObjectState {
  std::string id;     ///< Instance, e.g. "chair_1".
  std::string model;  ///< Name of its ObjectModel.
  Pose2 map_T_object;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< See PoseGaussian.
  Twist2 twist;                                          ///< In the object frame.
  double stamp_s = 0.0;                                  ///< When it was last seen.
  bool moving = false;
};

/// All that a behaviour knows at one instant.
struct Observation {
  double stamp_s = 0.0;  ///< Now.
  Pose2 map_T_robot;
  double robot_stamp_s = 0.0;  ///< When the robot's pose was estimated.
  Twist2 robot_twist;          ///< In the robot frame.
  std::vector<ObjectState> objects;

  /// nullptr if the object has never been seen.
  const ObjectState* object(const std::string& id) const;
};

/// What a behaviour asks of the base: velocity in the robot frame.
struct Command {
  Twist2 twist;
};

}  // namespace casepush
