#include "tag_pose.h"

#include <Eigen/Cholesky>

namespace casepush::sim {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix86 = Eigen::Matrix<double, 8, 6>;

constexpr int kMaxIterations = 30;
constexpr double kConverged = 1e-12;

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// Moves a pose by a translation and a rotation, both along the camera's axes.
Eigen::Isometry3d moved(const Eigen::Isometry3d& camera_T_tag, const Vector6& delta) {
  Eigen::Isometry3d result = camera_T_tag;
  result.translation() += delta.head<3>();
  const Eigen::Vector3d rotation = delta.tail<3>();
  const double angle = rotation.norm();
  if (angle > 0.0) {
    result.linear() =
        Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix() * camera_T_tag.linear();
  }
  return result;
}

Vector8 residual(const CameraModel& camera, double size_m, const Corners& corners_px,
                 const Eigen::Isometry3d& camera_T_tag) {
  Vector8 result;
  const auto corners = tagCorners(size_m);
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    result.segment<2>(2 * i) = corners_px[k] - project(camera, camera_T_tag * corners[k]);
  }
  return result;
}

// Derivative of the projected corners with respect to `moved`'s delta.
Matrix86 jacobian(const CameraModel& camera, double size_m, const Eigen::Isometry3d& camera_T_tag) {
  Matrix86 result;
  const auto corners = tagCorners(size_m);
  const double f = camera.focalPx();
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d arm = camera_T_tag.linear() * corners[static_cast<std::size_t>(i)];
    const Eigen::Vector3d p = camera_T_tag.translation() + arm;
    Eigen::Matrix<double, 2, 3> image;
    image << f / p.z(), 0.0, -f * p.x() / (p.z() * p.z()), 0.0, f / p.z(),
        -f * p.y() / (p.z() * p.z());
    result.block<2, 3>(2 * i, 0) = image;
    result.block<2, 3>(2 * i, 3) = -image * crossMatrix(arm);
  }
  return result;
}

}  // namespace

std::array<Eigen::Vector3d, 4> tagCorners(double size_m) {
  const double h = 0.5 * size_m;
  return {Eigen::Vector3d(-h, h, 0.0), Eigen::Vector3d(h, h, 0.0), Eigen::Vector3d(h, -h, 0.0),
          Eigen::Vector3d(-h, -h, 0.0)};
}

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& camera_p) {
  const double f = camera.focalPx();
  return {f * camera_p.x() / camera_p.z() + 0.5 * camera.width_px,
          f * camera_p.y() / camera_p.z() + 0.5 * camera.height_px};
}

TagPoseEstimate estimateTagPose(const CameraModel& camera, double size_m, const Corners& corners_px,
                                const Eigen::Isometry3d& initial, double corner_noise_px) {
  Eigen::Isometry3d pose = initial;
  Vector8 error = residual(camera, size_m, corners_px, pose);
  double damping = 1e-6;
  for (int i = 0; i < kMaxIterations && error.squaredNorm() > 0.0; ++i) {
    const Matrix86 j = jacobian(camera, size_m, pose);
    Matrix6 normal = j.transpose() * j;
    normal.diagonal() *= 1.0 + damping;
    const Vector6 delta = normal.ldlt().solve(j.transpose() * error);
    const Eigen::Isometry3d candidate = moved(pose, delta);
    const Vector8 candidate_error = residual(camera, size_m, corners_px, candidate);
    if (candidate_error.squaredNorm() < error.squaredNorm()) {
      pose = candidate;
      error = candidate_error;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
    if (delta.squaredNorm() < kConverged) break;
  }
  const Matrix86 j = jacobian(camera, size_m, pose);
  const Matrix6 information = j.transpose() * j;
  TagPoseEstimate estimate;
  estimate.camera_T_tag = pose;
  estimate.covariance =
      corner_noise_px * corner_noise_px * information.ldlt().solve(Matrix6::Identity());
  estimate.covariance = 0.5 * (estimate.covariance + estimate.covariance.transpose()).eval();
  return estimate;
}

}  // namespace casepush::sim
