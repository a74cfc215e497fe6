#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <tf2_ros/buffer.h>

#include <optional>
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
/// differ by less, and what comes from farther in the future is a mistake. With simulated time 5 s,
/// since a fast simulator's clock may come later than what is stamped by it.
bool isAhead(double stamp_s);

/// Looks after transforms from the future: TF would refuse all later ones with right stamps.
class AheadWatch {
 public:
  /// Forgets all transforms but static ones if the robot's latest pose has been ahead for 0.05 s of
  /// wall time; for shorter, the clock's message may be on its way.
  /// @return  One line that says that it is ahead; empty: it is not.
  std::string check(tf2_ros::Buffer& buffer);

 private:
  std::optional<ros::SteadyTime> since_;
};

/// A goal in any TF frame, expressed in the map by the latest transform; its planar part.
/// @throws InputError if there is no transform or it is tilted.
Pose2 poseInMap(const tf2_ros::Buffer& buffer, const geometry_msgs::PoseStamped& pose);

}  // namespace casepush
