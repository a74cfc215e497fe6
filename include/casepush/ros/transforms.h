#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <tf2_ros/buffer.h>

#include "casepush/common/pose2.h"

namespace casepush {

struct StampedRobotPose {
  Pose2 map_T_robot;
  double stamp_s = 0.0;
};

/// The latest pose of the base in the map. @throws tf2::TransformException, InputError.
StampedRobotPose robotPose(const tf2_ros::Buffer& buffer);

/// A pose in any TF frame, expressed in the map by the latest transform; its planar part.
/// @throws tf2::TransformException, InputError.
Pose2 poseInMap(const tf2_ros::Buffer& buffer, const geometry_msgs::PoseStamped& pose);

}  // namespace casepush
