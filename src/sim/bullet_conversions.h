#pragma once

#include <LinearMath/btTransform.h>

#include <Eigen/Geometry>
#include <cmath>

#include "casepush/common/pose2.h"

namespace casepush::sim {

inline btVector3 toBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline Eigen::Vector3d toEigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

inline btMatrix3x3 toBullet(const Eigen::Matrix3d& r) {
  return {r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)};
}

inline btTransform toBullet(const Eigen::Isometry3d& a_T_b) {
  return btTransform(toBullet(Eigen::Matrix3d(a_T_b.linear())),
                     toBullet(Eigen::Vector3d(a_T_b.translation())));
}

inline Eigen::Isometry3d toEigen(const btTransform& a_T_b) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i, j) = a_T_b.getBasis()[i][j];
    }
    result(i, 3) = a_T_b.getOrigin()[i];
  }
  return result;
}

inline Eigen::Isometry3d toSpatial(const Pose2& pose) {
  Eigen::Isometry3d result(Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ()));
  result.translation() << pose.x(), pose.y(), 0.0;
  return result;
}

/// Position and heading of a body that stands about upright.
inline Pose2 toPlanar(const Eigen::Isometry3d& pose) {
  return {pose(0, 3), pose(1, 3), std::atan2(pose(1, 0), pose(0, 0))};
}

}  // namespace casepush::sim
