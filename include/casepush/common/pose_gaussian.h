#pragma once

#include <Eigen/Core>
#include <array>

#include "casepush/common/pose2.h"

namespace casepush {

/// A Gaussian on SE(2): x = mean * exp(e) with e ~ N(0, covariance) in the frame of the mean.
/// Covariance rows and columns are x [m], y [m], yaw [rad].
struct PoseGaussian {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Number of sigma points of a 3-dimensional state: 2L + 1 (paper eq. 4-6).
constexpr int kSigmaPointCount = 7;

/// Sigma points of the paper's eq. 4-6: the mean, then mean +/- zeta * columns of the matrix root.
///
/// The eigenvector root is taken, so that the points are the true extremes of the ellipsoid.
/// @pre covariance is symmetric positive semi-definite and zeta >= 0.
std::array<Pose2, kSigmaPointCount> sigmaPoints(const PoseGaussian& gaussian, double zeta);

/// True if the matrix is finite, symmetric to 1e-9 relative and has no eigenvalue below -1e-12.
bool isCovariance(const Eigen::Matrix3d& matrix);

/// Expresses a Gaussian given in frame b in frame a. The covariance stays in the mean's own frame.
PoseGaussian transform(const Pose2& a_T_b, const PoseGaussian& b_gaussian);

/// The Gaussian of the product x * y of independent x ~ `a_gaussian_b` and y ~ `b_gaussian_c`, to
/// first order: where frame c is seen from a if both b in a and c in b are uncertain. The
/// covariance is in the frame of the resulting mean, as everywhere.
///
/// With y = mean_y * exp(e_y): x * y = mean_x * mean_y * exp(Ad(mean_y^-1) e_x) * exp(e_y). Smith
/// and Cheeseman 1986; Barfoot, State Estimation for Robotics, section 7.3.
PoseGaussian compound(const PoseGaussian& a_gaussian_b, const PoseGaussian& b_gaussian_c);

/// A matrix R with R * R^T = covariance: R * z of a standard normal z has this covariance.
/// @pre covariance is symmetric positive semi-definite.
Eigen::Matrix3d covarianceRoot(const Eigen::Matrix3d& covariance);

}  // namespace casepush
