#include "casepush/common/pose_gaussian.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"

namespace casepush {

std::array<Pose2, kSigmaPointCount> sigmaPoints(const PoseGaussian& gaussian, double zeta) {
  CASEPUSH_CHECK(zeta >= 0.0, "zeta = " << zeta);
  const Eigen::Matrix3d root = covarianceRoot(gaussian.covariance);
  std::array<Pose2, kSigmaPointCount> points;
  points[0] = gaussian.mean;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d offset = zeta * root.col(i);
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

PoseGaussian compound(const PoseGaussian& a_gaussian_b, const PoseGaussian& b_gaussian_c) {
  const Eigen::Matrix3d carry = adjointSe2(b_gaussian_c.mean.inverse());
  const Eigen::Matrix3d sum =
      carry * a_gaussian_b.covariance * carry.transpose() + b_gaussian_c.covariance;
  return {a_gaussian_b.mean * b_gaussian_c.mean, 0.5 * (sum + sum.transpose())};
}

Eigen::Matrix3d covarianceRoot(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace casepush
