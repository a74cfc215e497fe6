#include "casepush/common/pose_gaussian.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"

namespace casepush {

std::array<Pose2, kSigmaPointCount> sigmaPoints(const PoseGaussian& gaussian, double zeta) {
  CASEPUSH_CHECK(zeta >= 0.0, "zeta = " << zeta);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(gaussian.covariance);
  std::array<Pose2, kSigmaPointCount> points;
  points[0] = gaussian.mean;
  for (int i = 0; i < 3; ++i) {
    const double spread = zeta * std::sqrt(std::max(0.0, solver.eigenvalues()(i)));
    const Eigen::Vector3d offset = spread * solver.eigenvectors().col(i);
    points[1 + i] = gaussian.mean * expSe2(offset);
    points[4 + i] = gaussian.mean * expSe2(-offset);
  }
  return points;
}

bool isCovariance(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite()) {
    return false;
  }
  const double scale = std::max(1e-12, matrix.cwiseAbs().maxCoeff());
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) {
    return false;
  }
  if (matrix.llt().info() == Eigen::Success) {
    return true;  // A root proves it, twenty times as fast as eigenvalues.
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -1e-12;
}

PoseGaussian transform(const Pose2& a_T_b, const PoseGaussian& b_gaussian) {
  return {a_T_b * b_gaussian.mean, b_gaussian.covariance};
}

}  // namespace casepush
