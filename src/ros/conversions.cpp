#include "casepush/ros/conversions.h"

#include <cmath>
#include <cstring>
#include <optional>

#include "casepush/common/input_error.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr char kOpticalSuffix[] = "_optical_frame";
constexpr char kRangeSuffix[] = "_frame";
constexpr double kQuaternionTolerance = 1e-3;

std_msgs::Header mapHeader(double stamp_s) {
  std_msgs::Header header;
  header.stamp = toRosTime(stamp_s);
  header.frame_id = names::kMapFrame;
  return header;
}

Eigen::Isometry3d isometry(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation) {
  if (!position.allFinite() || !rotation.coeffs().allFinite()) {
    throw InputError("pose message", "a number is not finite");
  }
  if (std::abs(rotation.norm() - 1.0) > kQuaternionTolerance) {
    throw InputError("pose message", "the orientation is no unit quaternion (length " +
                                         std::to_string(rotation.norm()) + ")");
  }
  return Eigen::Translation3d(position) * rotation.normalized();
}

Eigen::Matrix<double, 6, 6> rowMajor6(const boost::array<double, 36>& values) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data());
}

boost::array<double, 36> rowMajor6(const Eigen::Matrix<double, 6, 6>& matrix) {
  boost::array<double, 36> values;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data()) = matrix;
  return values;
}

/// Rotation about z as it acts on (x, y, yaw).
Eigen::Matrix3d planarRotation(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// Rows of x, y and yaw in the covariance of geometry_msgs/PoseWithCovariance.
constexpr int kPlanarRows[] = {0, 1, 5};

}  // namespace

ros::Time toRosTime(double stamp_s) { return ros::Time(std::max(0.0, stamp_s)); }

geometry_msgs::Pose2D toMessage(const Pose2& pose) {
  geometry_msgs::Pose2D message;
  message.x = pose.x();
  message.y = pose.y();
  message.theta = pose.yaw();
  return message;
}

geometry_msgs::Pose toPoseMessage(const Pose2& pose) { return toMessage(spatialPose(pose)); }

geometry_msgs::Pose toMessage(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.rotation());
  geometry_msgs::Pose message;
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

geometry_msgs::Transform toTransformMessage(const Pose2& pose) {
  return toTransformMessage(spatialPose(pose));
}

geometry_msgs::Transform toTransformMessage(const Eigen::Isometry3d& pose) {
  const geometry_msgs::Pose as_pose = toMessage(pose);
  geometry_msgs::Transform message;
  message.translation.x = as_pose.position.x;
  message.translation.y = as_pose.position.y;
  message.translation.z = as_pose.position.z;
  message.rotation = as_pose.orientation;
  return message;
}

geometry_msgs::Twist toMessage(const Twist2& twist) {
  geometry_msgs::Twist message;
  message.linear.x = twist.vx_mps;
  message.linear.y = twist.vy_mps;
  message.angular.z = twist.wz_rps;
  return message;
}

Pose2 fromMessage(const geometry_msgs::Pose2D& message) {
  if (!std::isfinite(message.x) || !std::isfinite(message.y) || !std::isfinite(message.theta)) {
    throw InputError("pose message", "a number is not finite");
  }
  return Pose2(message.x, message.y, message.theta);
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& message) {
  const geometry_msgs::Point& p = message.position;
  const geometry_msgs::Quaternion& q = message.orientation;
  return isometry({p.x, p.y, p.z}, Eigen::Quaterniond(q.w, q.x, q.y, q.z));
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& message) {
  const geometry_msgs::Vector3& p = message.translation;
  const geometry_msgs::Quaternion& q = message.rotation;
  return isometry({p.x, p.y, p.z}, Eigen::Quaterniond(q.w, q.x, q.y, q.z));
}

Twist2 fromMessage(const geometry_msgs::Twist& message) {
  const Twist2 twist{message.linear.x, message.linear.y, message.angular.z};
  if (!twist.isFinite()) {
    throw InputError("twist message", "a number is not finite");
  }
  return twist;
}

Pose2 planarPose(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d rotation = pose.rotation();
  return Pose2(pose.translation().x(), pose.translation().y(),
               std::atan2(rotation(1, 0), rotation(0, 0)));
}

Eigen::Isometry3d spatialPose(const Pose2& pose) {
  return Eigen::Translation3d(pose.x(), pose.y(), 0.0) *
         Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ());
}

Pose2DWithCovariance toMessage(const PoseGaussian& gaussian) {
  Pose2DWithCovariance message;
  message.mean = toMessage(gaussian.mean);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.covariance.data()) =
      gaussian.covariance;
  return message;
}

PoseGaussian fromMessage(const Pose2DWithCovariance& message) {
  PoseGaussian gaussian;
  gaussian.mean = fromMessage(message.mean);
  gaussian.covariance =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.covariance.data());
  if (!isCovariance(gaussian.covariance)) {
    throw InputError("pose message", "the covariance is not positive semi-definite");
  }
  return gaussian;
}

ObjectPose toMessage(const PlacedObject& object) {
  ObjectPose message;
  message.id = object.id;
  message.model = object.model;
  message.pose = toMessage(object.map_T_object);
  return message;
}

PlacedObject fromMessage(const ObjectPose& message) {
  return {message.id, message.model, fromMessage(message.pose)};
}

PushableObject toMessage(const ObjectState& state, double now_s) {
  PushableObject message;
  message.id = state.id;
  message.model = state.model;
  message.pose.pose = toPoseMessage(state.map_T_object);
  const Eigen::Matrix3d rotation = planarRotation(state.map_T_object.yaw());
  const Eigen::Matrix3d map_covariance = rotation * state.covariance * rotation.transpose();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      covariance(kPlanarRows[row], kPlanarRows[column]) = map_covariance(row, column);
    }
  }
  message.pose.covariance = rowMajor6(covariance);
  message.twist = toMessage(state.twist);
  message.last_seen = toRosTime(state.stamp_s);
  message.age = now_s - state.stamp_s;
  message.moving = state.moving;
  return message;
}

ObjectState fromMessage(const PushableObject& message) {
  ObjectState state;
  state.id = message.id;
  state.model = message.model;
  state.map_T_object = planarPose(fromMessage(message.pose.pose));
  const Eigen::Matrix<double, 6, 6> covariance = rowMajor6(message.pose.covariance);
  Eigen::Matrix3d map_covariance;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      map_covariance(row, column) = covariance(kPlanarRows[row], kPlanarRows[column]);
    }
  }
  const Eigen::Matrix3d rotation = planarRotation(state.map_T_object.yaw());
  state.covariance = rotation.transpose() * map_covariance * rotation;
  if (!isCovariance(state.covariance)) {
    throw InputError("object " + state.id, "the covariance is not positive semi-definite");
  }
  state.twist = fromMessage(message.twist);
  state.stamp_s = message.last_seen.toSec();
  state.moving = message.moving;
  return state;
}

PushableObjectArray toMessage(const std::vector<ObjectState>& states, double now_s) {
  PushableObjectArray message;
  message.header = mapHeader(now_s);
  for (const ObjectState& state : states) {
    message.objects.push_back(toMessage(state, now_s));
  }
  return message;
}

std::vector<ObjectState> fromMessage(const PushableObjectArray& message) {
  std::vector<ObjectState> states;
  for (const PushableObject& object : message.objects) {
    states.push_back(fromMessage(object));
  }
  return states;
}

std::string opticalFrame(const std::string& camera) { return camera + kOpticalSuffix; }

std::string rangeFrame(const std::string& range_sensor) { return range_sensor + kRangeSuffix; }

std::string cameraOfFrame(const std::string& frame_id) {
  const std::string suffix = kOpticalSuffix;
  const bool matches =
      frame_id.size() > suffix.size() &&
      frame_id.compare(frame_id.size() - suffix.size(), suffix.size(), suffix) == 0;
  return matches ? frame_id.substr(0, frame_id.size() - suffix.size()) : "";
}

AprilTagDetectionArray toMessage(const TagFrame& frame) {
  AprilTagDetectionArray message;
  message.header.stamp = toRosTime(frame.stamp_s);
  message.header.frame_id = opticalFrame(frame.camera);
  for (const TagDetection& detection : frame.detections) {
    AprilTagDetection tag;
    tag.id = {detection.id};
    tag.size = {detection.size_m};
    tag.pose.header = message.header;
    tag.pose.pose.pose = toMessage(detection.camera_T_tag);
    tag.pose.pose.covariance = rowMajor6(detection.covariance);
    message.detections.push_back(tag);
  }
  return message;
}

TagFrame fromMessage(const AprilTagDetectionArray& message, std::string* left_out) {
  TagFrame frame;
  frame.camera = cameraOfFrame(message.header.frame_id);
  frame.stamp_s = message.header.stamp.toSec();
  if (left_out != nullptr) left_out->clear();
  for (const AprilTagDetection& tag : message.detections) {
    if (tag.id.size() != 1 || tag.size.size() != 1) {
      continue;
    }
    TagDetection detection;
    detection.id = tag.id.front();
    detection.size_m = tag.size.front();
    try {
      detection.camera_T_tag = fromMessage(tag.pose.pose.pose);
    } catch (const InputError& error) {
      if (left_out != nullptr) {
        *left_out += (left_out->empty() ? "tag " : "; tag ") + std::to_string(detection.id) + ": " +
                     error.what();
      }
      continue;
    }
    detection.covariance = rowMajor6(tag.pose.pose.covariance);
    frame.detections.push_back(detection);
  }
  return frame;
}

nav_msgs::Odometry toMessage(const OdometryReading& reading) {
  nav_msgs::Odometry message;
  message.header.stamp = toRosTime(reading.stamp_s);
  message.header.frame_id = names::kOdomFrame;
  message.child_frame_id = names::kBaseFrame;
  message.pose.pose = toPoseMessage(reading.odom_T_robot);
  message.twist.twist = toMessage(reading.robot_twist);
  return message;
}

ObjectLoad toMessage(const std::string& id, const Load& load) {
  ObjectLoad message;
  message.id = id;
  message.mass = load.mass_kg;
  message.centre.x = load.object_p_centre_m.x();
  message.centre.y = load.object_p_centre_m.y();
  message.centre.z = load.height_m.value_or(0.0);
  message.size.x = load.size_m.x();
  message.size.y = load.size_m.y();
  message.size.z = load.size_m.z();
  return message;
}

Load fromMessage(const ObjectLoad& message) {
  Load load;
  load.mass_kg = message.mass;
  load.object_p_centre_m << message.centre.x, message.centre.y;
  if (message.centre.z != 0.0) {
    load.height_m = message.centre.z;
  }
  const Eigen::Vector3d size_m(message.size.x, message.size.y, message.size.z);
  if (!size_m.isZero(0.0)) {
    load.size_m = size_m;
  }
  return load;
}

BodyContactArray toMessage(const std::vector<ContactReport>& contacts, double stamp_s) {
  BodyContactArray message;
  message.header = mapHeader(stamp_s);
  for (const ContactReport& report : contacts) {
    BodyContact contact;
    contact.body_a = report.body_a;
    contact.part_a = report.part_a;
    contact.body_b = report.body_b;
    contact.part_b = report.part_b;
    contact.impulse = report.impulse_ns;
    contact.point.x = report.map_point.x();
    contact.point.y = report.map_point.y();
    contact.point.z = report.map_point.z();
    message.contacts.push_back(contact);
  }
  return message;
}

}  // namespace casepush
