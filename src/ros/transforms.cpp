#include "casepush/ros/transforms.h"

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {

StampedRobotPose robotPose(const tf2_ros::Buffer& buffer) {
  const geometry_msgs::TransformStamped transform =
      buffer.lookupTransform(names::kMapFrame, names::kBaseFrame, ros::Time(0));
  return {planarPose(fromMessage(transform.transform)), transform.header.stamp.toSec()};
}

Pose2 poseInMap(const tf2_ros::Buffer& buffer, const geometry_msgs::PoseStamped& pose) {
  const Eigen::Isometry3d frame_T_pose = fromMessage(pose.pose);
  const std::string& frame = pose.header.frame_id;
  if (frame.empty()) {
    throw InputError("goal", "header.frame_id is empty; give a TF frame, e.g. map");
  }
  if (frame == names::kMapFrame) {
    return planarPose(frame_T_pose);
  }
  const geometry_msgs::TransformStamped map_T_frame =
      buffer.lookupTransform(names::kMapFrame, frame, ros::Time(0));
  return planarPose(fromMessage(map_T_frame.transform) * frame_T_pose);
}

}  // namespace casepush
