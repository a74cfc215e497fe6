#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <tf2_ros/buffer.h>

#include <string>

#include "casepush/common/pose2.h"

namespace casepush {

struct StampedRobotPose {
  Pose2 map_T_robot;
  double stamp_s = 0.0;
};

/// The latest pose of the base in the map. @throws InputError if it is unknown.
StampedRobotPose robotPose(const tf2_ros::Buffer& buffer);

/// True if a stamp is more than half a second ahead of the ROS clock: clocks of two machines may
/// differ by less, and what comes from farther in the future is a mistake.
bool isAhead(double stamp_s);

/// Forgets all transforms but static ones if the robot's latest pose is ahead, since TF would
/// refuse all later ones with right stamps. @return  One line that says so; empty: they are kept.
std::string forgetIfAhead(tf2_ros::Buffer& buffer);

/// A goal in any TF frame, expressed in the map by the latest transform; its planar part.
/// @throws InputError if there is no transform or it is tilted.
Pose2 poseInMap(const tf2_ros::Buffer& buffer, const geometry_msgs::PoseStamped& pose);

}  // namespace casepush
