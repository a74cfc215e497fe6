#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace casepush {

/// One tag seen in one image.
struct TagDetection {
  int id = 0;
  double size_m = 0.0;
  Eigen::Isometry3d camera_T_tag = Eigen::Isometry3d::Identity();  ///< Optical frame.
  /// Of x, y, z [m] and roll, pitch, yaw [rad] about the camera's axes, as in
  /// geometry_msgs/PoseWithCovariance.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// All tags of one image; empty if none was seen.
struct TagFrame {
  std::string camera;    ///< Name of the robot's camera.
  double stamp_s = 0.0;  ///< When the image was taken.
  std::vector<TagDetection> detections;
};

}  // namespace casepush
