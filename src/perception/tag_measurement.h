#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "casepush/common/pose2.h"
#include "casepush/model/tag_detection.h"

namespace casepush {

/// What one tag says about its object: map pose with covariance of (x, y, yaw) in map axes.
struct PoseMeasurement {
  Pose2 map_T_object;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
};

/// Where a detection comes from.
struct TagView {
  Pose2 map_T_robot;
  Eigen::Isometry3d base_T_camera = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d object_T_tag = Eigen::Isometry3d::Identity();
};

/// Standard deviations that a measurement is judged with.
struct MeasurementNoise {
  double upright_m;
  double upright_rad;
  double localisation_m;
  double localisation_rad;
};

/// Covariance of (x, y, yaw) in map axes that the robot's own pose error adds to an object's pose.
Eigen::Matrix3d localisationCovariance(const Pose2& map_T_robot, const Eigen::Vector2d& map_object,
                                       const MeasurementNoise& noise);

/// Projects a detection to the floor.
///
/// map_T_object = map_T_robot base_T_camera camera_T_tag object_T_tag^-1, with the 6x6 covariance
/// carried along the lever arm from tag to object. The six-dimensional result is then conditioned
/// on the object standing upright on the floor.
/// @return  Nothing if the detection is not finite, its covariance is none, or the object would
/// float
///   or tilt more than `gate_p_value` allows (e.g. a flipped planar pose).
std::optional<PoseMeasurement> measureObject(const TagDetection& detection, const TagView& view,
                                             const MeasurementNoise& noise, double gate_p_value);

}  // namespace casepush
