#include "casepush/ros/transforms.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr double kMostTilt_rad = 0.2;
constexpr double kAheadS = 0.5;
constexpr double kSimulatedAheadS = 5.0;
constexpr double kPatienceS = 0.05;  // Wall time.

/// The latest one. @throws InputError: `where`, then what TF says.
geometry_msgs::TransformStamped mapTransform(const tf2_ros::Buffer& buffer,
                                             const std::string& frame, const std::string& where) {
  try {
    return buffer.lookupTransform(names::kMapFrame, frame, ros::Time(0));
  } catch (const tf2::TransformException& error) {
    const std::string text = error.what();
    throw InputError(where, text.substr(0, text.find_last_not_of(" \n") + 1));
  }
}

}  // namespace

StampedRobotPose robotPose(const tf2_ros::Buffer& buffer) {
  const geometry_msgs::TransformStamped transform =
      mapTransform(buffer, names::kBaseFrame, "the robot's pose is unknown (TF map -> base_link)");
  return {planarPose(fromMessage(transform.transform)), transform.header.stamp.toSec()};
}

bool isAhead(double stamp_s) {
  const ros::Time now = ros::Time::now();
  const double most_s = ros::Time::isSimTime() ? kSimulatedAheadS : kAheadS;
  return !now.isZero() && stamp_s - now.toSec() > most_s;
}

std::string AheadWatch::check(tf2_ros::Buffer& buffer) {
  double stamp_s = 0.0;
  try {
    stamp_s = robotPose(buffer).stamp_s;
  } catch (const InputError& error) {
    // Nothing to forget.
  }
  if (!isAhead(stamp_s)) {
    since_.reset();
    return "";
  }
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!since_) since_ = now;
  if ((now - *since_).toSec() > kPatienceS) buffer.clear();
  std::ostringstream line;
  line << "TF map -> base_link is stamped " << stamp_s - ros::Time::now().toSec()
       << " s ahead of the clock";
  return line.str();
}

Pose2 poseInMap(const tf2_ros::Buffer& buffer, const geometry_msgs::PoseStamped& pose) {
  Eigen::Isometry3d map_T_pose = fromMessage(pose.pose);
  const std::string& frame = pose.header.frame_id;
  if (frame.empty()) {
    throw InputError("goal", "header.frame_id is empty; give a TF frame, e.g. map");
  }
  if (frame != names::kMapFrame) {
    const geometry_msgs::TransformStamped map_T_frame =
        mapTransform(buffer, frame, "goal: there is no TF from '" + frame + "' to map");
    map_T_pose = fromMessage(map_T_frame.transform) * map_T_pose;
  }
  const double tilt_rad = std::acos(std::clamp(map_T_pose.linear()(2, 2), -1.0, 1.0));
  if (tilt_rad > kMostTilt_rad) {
    throw InputError("goal", "is tilted by " +
                                 std::to_string(std::lround(tilt_rad * 180.0 / M_PI)) +
                                 " deg in the map; objects stand upright, so only yaw may differ");
  }
  return planarPose(map_T_pose);
}

}  // namespace casepush
