#include "casepush/common/pose_gaussian.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/random.h"

namespace casepush {
namespace {

Eigen::Matrix3d randomCovariance(Random* random) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) {
    root(i / 3, i % 3) = random->uniform(-0.1, 0.1);
  }
  return root * root.transpose() + 1e-4 * Eigen::Matrix3d::Identity();
}

TEST(SigmaPoints, lieOnTheEllipsoid) {
  Random random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const PoseGaussian gaussian{Pose2(1.0, -2.0, 3.1), randomCovariance(&random)};
    const auto points = sigmaPoints(gaussian, 3.0);
    EXPECT_LT(distance(points[0], gaussian.mean), 1e-12);
    for (int i = 1; i < kSigmaPointCount; ++i) {
      const Eigen::Vector3d e = logSe2(gaussian.mean.inverse() * points[i]);
      EXPECT_NEAR(e.dot(gaussian.covariance.inverse() * e), 9.0, 1e-6);
    }
  }
}

TEST(SigmaPoints, haveTheGaussiansMeanAndCovariance) {
  Random random(2);
  const PoseGaussian gaussian{Pose2(0.5, 0.2, -3.0), randomCovariance(&random)};
  const double zeta = 2.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Pose2& point : sigmaPoints(gaussian, zeta)) {
    const Eigen::Vector3d e = logSe2(gaussian.mean.inverse() * point);
    sum += e;
    spread += e * e.transpose();
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT((spread / (2.0 * zeta * zeta) - gaussian.covariance).norm(), 1e-12);
}

TEST(SigmaPoints, reachTheTrueExtremesWhereCholeskyDoesNot) {
  // An ellipse at 45 degrees with half axes sqrt(1.5) and sqrt(0.5) m. The longest column of its
  // Cholesky root is (1, 0.5), 1.118 m.
  PoseGaussian gaussian;
  gaussian.covariance << 1.0, 0.5, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1e-6;
  double farthest_m = 0.0;
  for (const Pose2& point : sigmaPoints(gaussian, 1.0)) {
    farthest_m = std::max(farthest_m, point.position().norm());
  }
  EXPECT_NEAR(farthest_m, std::sqrt(1.5), 1e-6);
}

TEST(SigmaPoints, collapseWithoutUncertainty) {
  const PoseGaussian gaussian{Pose2(1, 2, 0.5), Eigen::Matrix3d::Zero()};
  for (const Pose2& point : sigmaPoints(gaussian, 3.0)) {
    EXPECT_LT(distance(point, gaussian.mean), 1e-12);
    EXPECT_NEAR(yawDifference(point, gaussian.mean), 0.0, 1e-12);
  }
}

TEST(SigmaPointsDeathTest, refuseNegativeZeta) {
  EXPECT_DEATH(sigmaPoints(PoseGaussian(), -1.0), "zeta = -1");
}

TEST(IsCovariance, refusesWhatIsNone) {
  EXPECT_TRUE(isCovariance(Eigen::Matrix3d::Zero()));
  EXPECT_TRUE(isCovariance(Eigen::Matrix3d::Identity()));
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 1) = 0.1;
  EXPECT_FALSE(isCovariance(matrix)) << "asymmetric";
  matrix(1, 0) = 0.1;
  EXPECT_TRUE(isCovariance(matrix));
  matrix(0, 1) = matrix(1, 0) = 1.1;
  EXPECT_FALSE(isCovariance(matrix)) << "indefinite";
  matrix = Eigen::Matrix3d::Identity();
  matrix(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(isCovariance(matrix)) << "not finite";
}

TEST(Transform, movesTheMeanAndKeepsTheBodyCovariance) {
  Random random(3);
  const Pose2 map_T_start(3.0, -1.0, 2.0);
  const PoseGaussian start{Pose2(0.4, 0.1, 0.3), randomCovariance(&random)};
  const PoseGaussian map = transform(map_T_start, start);
  EXPECT_LT(distance(map.mean, map_T_start * start.mean), 1e-12);
  const auto start_points = sigmaPoints(start, 3.0);
  const auto map_points = sigmaPoints(map, 3.0);
  for (int i = 0; i < kSigmaPointCount; ++i) {
    EXPECT_LT(distance(map_points[i], map_T_start * start_points[i]), 1e-12);
  }
}

TEST(Compound, isTheProductOfIndependentPosesToFirstOrder) {
  Random random(4);
  const auto draw = [&random](const PoseGaussian& gaussian) {
    const Eigen::Vector3d normal(random.normal(1.0), random.normal(1.0), random.normal(1.0));
    return gaussian.mean * expSe2(covarianceRoot(gaussian.covariance) * normal);
  };
  const PoseGaussian a{Pose2(1.0, -2.0, 2.5), randomCovariance(&random)};
  const PoseGaussian b{Pose2(0.7, 0.3, -1.2), randomCovariance(&random)};
  const PoseGaussian c = compound(a, b);
  EXPECT_LT(distance(c.mean, a.mean * b.mean), 1e-12);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 40000;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d e = logSe2(c.mean.inverse() * draw(a) * draw(b));
    spread += e * e.transpose() / kDraws;
  }
  EXPECT_LT((spread - c.covariance).norm(), 0.04 * spread.norm());
}

TEST(CovarianceRoot, isARootAlsoOfSingularOnes) {
  Random random(5);
  Eigen::Matrix3d covariance = randomCovariance(&random);
  EXPECT_LT(
      (covarianceRoot(covariance) * covarianceRoot(covariance).transpose() - covariance).norm(),
      1e-12);
  covariance = Eigen::Vector3d(0.1, 0.0, 0.2).asDiagonal();
  EXPECT_LT(
      (covarianceRoot(covariance) * covarianceRoot(covariance).transpose() - covariance).norm(),
      1e-12);
}

}  // namespace
}  // namespace casepush
