#pragma once

#include <Eigen/Geometry>
#include <array>

#include "casepush/model/robot_model.h"

namespace casepush::sim {

using Corners = std::array<Eigen::Vector2d, 4>;

/// Corners of a tag in its own frame, in AprilTag's order: from bottom left, counter-clockwise as
/// seen from the front.
std::array<Eigen::Vector3d, 4> tagCorners(double size_m);

/// Pinhole projection of a point in the optical frame [px]. @pre z > 0.
Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& camera_p);

struct TagPoseEstimate {
  Eigen::Isometry3d camera_T_tag = Eigen::Isometry3d::Identity();
  /// Of translation and rotation about the camera's axes, rotation at the tag's centre.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Pose of least reprojection error near `initial` (Levenberg-Marquardt), with the covariance that
/// corner noise of the given standard deviation implies.
TagPoseEstimate estimateTagPose(const CameraModel& camera, double size_m, const Corners& corners_px,
                                const Eigen::Isometry3d& initial, double corner_noise_px);

}  // namespace casepush::sim
