#include "tag_measurement.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "chi_square.h"

namespace casepush {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// A detection never counts as more precise than this: tags are printed and mounted by people.
constexpr double kMountSigmaM = 0.001;
constexpr double kMountSigmaRad = 0.002;

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Isometry3d toIsometry(const Pose2& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  result.translation() = Eigen::Vector3d(pose.x(), pose.y(), 0.0);
  return result;
}

bool isUsable(const TagDetection& detection) {
  if (!detection.camera_T_tag.matrix().allFinite() || !detection.covariance.allFinite()) {
    return false;
  }
  const Eigen::Matrix3d rotation = detection.camera_T_tag.linear();
  const bool orthonormal = (rotation.transpose() * rotation).isIdentity(1e-3);
  const Matrix6 symmetric = 0.5 * (detection.covariance + detection.covariance.transpose());
  // Without noise a covariance may be zero: positive semi-definite up to rounding is enough.
  const Matrix6 lifted = symmetric + 1e-9 * Matrix6::Identity();
  return orthonormal && Eigen::LLT<Matrix6>(lifted).info() == Eigen::Success;
}

// The object's full pose, as it deviates from an upright one: order x, y, yaw, z, roll, pitch in
// map axes; the first three absolute.
struct SpatialPose {
  Vector6 value;
  Matrix6 covariance;
};

SpatialPose spatialPose(const TagDetection& detection, const TagView& view) {
  const Eigen::Isometry3d map_T_camera = toIsometry(view.map_T_robot) * view.base_T_camera;
  const Eigen::Isometry3d tag_T_object = view.object_T_tag.inverse();
  const Eigen::Isometry3d map_T_object = map_T_camera * detection.camera_T_tag * tag_T_object;
  const Eigen::Matrix3d map_R_camera = map_T_camera.linear();
  const Eigen::Vector3d camera_lever = detection.camera_T_tag.linear() * tag_T_object.translation();

  // A detection error (dt, dphi) about the camera's axes moves the object by dt - lever x dphi.
  Eigen::Matrix<double, 3, 6> position_jacobian;
  position_jacobian << map_R_camera, -map_R_camera * crossMatrix(camera_lever);
  Eigen::Matrix<double, 3, 6> rotation_jacobian;
  rotation_jacobian << Eigen::Matrix3d::Zero(), map_R_camera;
  Matrix6 jacobian;
  jacobian << position_jacobian.row(0), position_jacobian.row(1), rotation_jacobian.row(2),
      position_jacobian.row(2), rotation_jacobian.row(0), rotation_jacobian.row(1);

  const Eigen::Matrix3d rotation = map_T_object.linear();
  const Eigen::Vector3d position = map_T_object.translation();
  SpatialPose pose;
  pose.value << position.x(), position.y(), std::atan2(rotation(1, 0), rotation(0, 0)),
      position.z(), -rotation(1, 2), rotation(0, 2);
  pose.covariance = jacobian * detection.covariance * jacobian.transpose();
  pose.covariance = 0.5 * (pose.covariance + pose.covariance.transpose()).eval();
  return pose;
}

}  // namespace

Eigen::Matrix3d localisationCovariance(const Pose2& map_T_robot, const Eigen::Vector2d& map_object,
                                       const MeasurementNoise& noise) {
  const Eigen::Vector2d lever = map_object - map_T_robot.position();
  const Eigen::Vector3d yaw_effect(-lever.y(), lever.x(), 1.0);
  const double position_variance = noise.localisation_m * noise.localisation_m;
  Eigen::Matrix3d covariance =
      noise.localisation_rad * noise.localisation_rad * yaw_effect * yaw_effect.transpose();
  covariance.diagonal() += Eigen::Vector3d(position_variance, position_variance, 0.0);
  return covariance;
}

std::optional<PoseMeasurement> measureObject(const TagDetection& detection, const TagView& view,
                                             const MeasurementNoise& noise, double gate_p_value) {
  if (!isUsable(detection)) {
    return std::nullopt;
  }
  const SpatialPose pose = spatialPose(detection, view);
  const Eigen::Vector3d off_floor = pose.value.tail<3>();
  Eigen::Matrix3d off_floor_covariance = pose.covariance.bottomRightCorner<3, 3>();
  off_floor_covariance.diagonal() +=
      Eigen::Vector3d(noise.upright_m, noise.upright_rad, noise.upright_rad).cwiseAbs2();
  const Eigen::LDLT<Eigen::Matrix3d> solver(off_floor_covariance);
  if (chiSquareTail3(off_floor.dot(solver.solve(off_floor))) < gate_p_value) {
    return std::nullopt;
  }

  // Conditional Gaussian given height, roll and pitch of zero.
  const Eigen::Matrix3d cross = pose.covariance.topRightCorner<3, 3>();
  const Eigen::Vector3d planar = pose.value.head<3>() - cross * solver.solve(off_floor);
  PoseMeasurement measurement;
  measurement.map_T_object = Pose2(planar.x(), planar.y(), planar.z());
  measurement.covariance = pose.covariance.topLeftCorner<3, 3>() -
                           cross * solver.solve(cross.transpose().eval()) +
                           localisationCovariance(view.map_T_robot, planar.head<2>(), noise);
  measurement.covariance.diagonal() +=
      Eigen::Vector3d(kMountSigmaM, kMountSigmaM, kMountSigmaRad).cwiseAbs2();
  return measurement;
}

}  // namespace casepush
