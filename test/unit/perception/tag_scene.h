#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/object_model.h"
#include "casepush/model/tag_detection.h"

namespace casepush::test {

inline Eigen::Isometry3d isometry(const Pose2& pose, double z_m = 0.0) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.x(), pose.y(), z_m);
  return result;
}

/// An optical frame (x right, y down, z forward) that looks along `yaw_rad` at height `z_m`.
inline Eigen::Isometry3d optical(const Pose2& pose, double z_m) {
  Eigen::Matrix3d forward_R_optical;
  forward_R_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d result = isometry(pose, z_m);
  result.linear() = result.linear() * forward_R_optical;
  return result;
}

/// An object with tags around it at 0.6 m height, 0.3 m from its axis. Tag ids from 10.
inline ObjectModel taggedObject(int tag_count) {
  ObjectModel model;
  model.name = "crate";
  for (int i = 0; i < tag_count; ++i) {
    const double angle = 2.0 * M_PI * i / tag_count;
    TagMount mount;
    mount.id = 10 + i;
    mount.size_m = 0.16;
    // A tag's z axis points into it: towards the object's axis.
    mount.object_T_tag =
        optical(Pose2(0.3 * std::cos(angle), 0.3 * std::sin(angle), angle + M_PI), 0.6);
    model.tags.push_back(mount);
  }
  return model;
}

/// Covariance like that of a planar tag: depth and tilt are much worse than the rest.
inline Eigen::Matrix<double, 6, 6> planarTagCovariance(double scale = 1.0) {
  Eigen::Matrix<double, 6, 1> sigma;
  sigma << 0.002, 0.002, 0.012, 0.04, 0.04, 0.006;
  return (scale * sigma).cwiseAbs2().asDiagonal();
}

/// What a camera sees of a tag, with an error drawn from `covariance` (none if `random` is null).
inline TagDetection detect(const TagMount& mount, const Pose2& map_T_object,
                           const Pose2& map_T_robot, const Eigen::Isometry3d& base_T_camera,
                           const Eigen::Matrix<double, 6, 6>& covariance, Random* random) {
  TagDetection detection;
  detection.id = mount.id;
  detection.size_m = mount.size_m;
  detection.covariance = covariance;
  detection.camera_T_tag = (isometry(map_T_robot) * base_T_camera).inverse() *
                           isometry(map_T_object) * mount.object_T_tag;
  if (random == nullptr) {
    return detection;
  }
  const Eigen::Matrix<double, 6, 6> root = covariance.llt().matrixL();
  Eigen::Matrix<double, 6, 1> unit;
  for (int i = 0; i < 6; ++i) {
    unit(i) = random->normal(1.0);
  }
  const Eigen::Matrix<double, 6, 1> error = root * unit;
  const Eigen::Vector3d turn = error.tail<3>();
  detection.camera_T_tag.translation() += error.head<3>();
  detection.camera_T_tag.linear() =
      Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() *
      detection.camera_T_tag.linear();
  return detection;
}

}  // namespace casepush::test
