#pragma once

#include <casepush/AprilTagDetectionArray.h>
#include <casepush/BodyContactArray.h>
#include <casepush/ObjectLoad.h>
#include <casepush/ObjectPose.h>
#include <casepush/Octomap.h>
#include <casepush/Pose2DWithCovariance.h>
#include <casepush/PushableObjectArray.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Pose2D.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "casepush/common/pose_gaussian.h"
#include "casepush/model/observation.h"
#include "casepush/model/push_plan.h"
#include "casepush/model/tag_detection.h"
#include "casepush/sim/simulator.h"
#include "casepush/world/map.h"
#include "casepush/world/occupancy_grid.h"

/// Geometry, sensors and maps between ROS messages and the core. `fromMessage` throws InputError on
/// numbers that are not finite and on quaternions that are not of unit length.
namespace casepush {

ros::Time toRosTime(double stamp_s);  ///< Times before 0 become 0.

geometry_msgs::Pose2D toMessage(const Pose2& pose);
geometry_msgs::Pose toPoseMessage(const Pose2& pose);
geometry_msgs::Pose toMessage(const Eigen::Isometry3d& pose);
geometry_msgs::Transform toTransformMessage(const Pose2& pose);
geometry_msgs::Transform toTransformMessage(const Eigen::Isometry3d& pose);
geometry_msgs::Twist toMessage(const Twist2& twist);

Pose2 fromMessage(const geometry_msgs::Pose2D& message);
Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& message);
Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& message);
Twist2 fromMessage(const geometry_msgs::Twist& message);

/// The planar part: x, y and the heading of the x axis.
Pose2 planarPose(const Eigen::Isometry3d& pose);
/// The planar pose on the floor.
Eigen::Isometry3d spatialPose(const Pose2& pose);

Pose2DWithCovariance toMessage(const PoseGaussian& gaussian);
PoseGaussian fromMessage(const Pose2DWithCovariance& message);

ObjectPose toMessage(const PlacedObject& object);
PlacedObject fromMessage(const ObjectPose& message);

/// The covariance turns from the object's frame (core) to the axes of the map (ROS).
PushableObject toMessage(const ObjectState& state, double now_s);
ObjectState fromMessage(const PushableObject& message);
PushableObjectArray toMessage(const std::vector<ObjectState>& states, double now_s);
std::vector<ObjectState> fromMessage(const PushableObjectArray& message);

/// Name of a camera's optical frame, and back; "" if it is no such name.
std::string opticalFrame(const std::string& camera);
std::string cameraOfFrame(const std::string& frame_id);

/// Name of a range sensor's frame: x forward, z up.
std::string rangeFrame(const std::string& range_sensor);

AprilTagDetectionArray toMessage(const TagFrame& frame);
/// Left out are bundles of several tags, whose poses are not those of a tag, and detections whose
/// pose makes no sense.
/// @param left_out  If given, says which made no sense and why; empty: none.
TagFrame fromMessage(const AprilTagDetectionArray& message, std::string* left_out = nullptr);

nav_msgs::Odometry toMessage(const OdometryReading& reading);
ObjectLoad toMessage(const std::string& id, const Load& load);
/// A height of 0 and a size of 0 stand for those that Load leaves open.
Load fromMessage(const ObjectLoad& message);
BodyContactArray toMessage(const std::vector<ContactReport>& contacts, double stamp_s);

sensor_msgs::PointCloud2 toMessage(const std::vector<Eigen::Vector3f>& map_points, double stamp_s);
/// Organised: a row for each layer; NaN where there was no return.
sensor_msgs::PointCloud2 toMessage(const RangeScan& scan);
/// Points that are not finite are left out.
/// @throws InputError if there are no x, y, z fields of type float32, or the sizes disagree.
std::vector<Eigen::Vector3f> fromMessage(const sensor_msgs::PointCloud2& message);
/// The same with all points, rows as layers, and the frame's name as the sensor's.
RangeScan scanFromMessage(const sensor_msgs::PointCloud2& message);

/// @throws InputError if the origin is tilted or off the floor.
OccupancyGrid fromMessage(const nav_msgs::OccupancyGrid& message);

Octomap toMessage(const Map& map, double stamp_s);
/// @throws InputError if it is not a binary OcTree.
Map fromMessage(const Octomap& message);

}  // namespace casepush
