#include "odometry.h"

#include <gtest/gtest.h>

#include <cmath>

namespace casepush::sim {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

/// Without any error; tests put in the one they look at.
OdometryModel exactModel() {
  OdometryModel model;
  model.scale = model.turn_scale = 0.0;
  model.position_per_metre_m = model.position_per_turn_m = 0.0;
  model.yaw_per_metre_rad = model.yaw_per_turn_rad = 0.0;
  return model;
}

Odometry driven(const OdometryModel& model, std::uint64_t seed, const Twist2& twist,
                double duration_s, double step_s = kStep_s) {
  Odometry odometry(model, true, Random(seed));
  const int steps = static_cast<int>(std::lround(duration_s / step_s));
  for (int i = 0; i < steps; ++i) {
    odometry.update(step_s, step_s * Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps),
                    twist);
  }
  return odometry;
}

/// Mean squares of the final pose's error in x, y and yaw over many runs.
Eigen::Vector3d meanSquares(const OdometryModel& model, const Twist2& twist, double duration_s,
                            double step_s = kStep_s) {
  constexpr int kRuns = 2000;
  const Pose2 truth =
      expSe2(duration_s * Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const Pose2 pose = driven(model, seed, twist, duration_s, step_s).odom_T_robot();
    const Eigen::Vector3d error(pose.x() - truth.x(), pose.y() - truth.y(),
                                wrapAngle(pose.yaw() - truth.yaw()));
    sum += error.cwiseAbs2();
  }
  return sum / kRuns;
}

constexpr double kTolerance = 0.13;  // Four standard deviations of a mean of 2000 squares.

TEST(Odometry, isExactWithoutNoiseAndAtRest) {
  const Twist2 twist{0.3, 0.1, 0.5};
  const Pose2 truth = expSe2({0.6, 0.2, 1.0});
  EXPECT_LT(distance(driven(exactModel(), 1, twist, 2.0).odom_T_robot(), truth), 1e-9);
  OdometryModel off;
  off.switches.noise = false;
  EXPECT_LT(distance(driven(off, 1, twist, 2.0).odom_T_robot(), truth), 1e-9);
  EXPECT_EQ(driven(off, 1, twist, 2.0).twist().wz_rps, 0.5);
  const Odometry resting = driven(OdometryModel(), 1, {}, 100.0);
  EXPECT_EQ(resting.odom_T_robot().x(), 0.0);
  EXPECT_EQ(resting.odom_T_robot().yaw(), 0.0);
  EXPECT_EQ(resting.twist().speed(), 0.0);
}

TEST(Odometry, scalesErrInProportionToTheDistanceAndAreBounded) {
  OdometryModel model = exactModel();
  model.scale = 0.02;
  model.turn_scale = 0.01;
  const Eigen::Vector3d after_one = meanSquares(model, {0.5, 0.0, 0.0}, 2.0);
  EXPECT_NEAR(after_one.x() / (0.02 * 0.02), 1.0, kTolerance);
  EXPECT_EQ(after_one.y(), 0.0);
  const Eigen::Vector3d turned = meanSquares(model, {0.0, 0.0, 1.0}, 2.0);
  EXPECT_NEAR(turned.z() / (0.02 * 0.02), 1.0, kTolerance);
  for (std::uint64_t seed = 1; seed < 2000; ++seed) {
    const Odometry odometry = driven(model, seed, {1.0, 0.0, 0.0}, 0.1);
    ASSERT_LE(std::abs(odometry.twist().vx_mps - 1.0), 0.06 + 1e-12);
  }
}

TEST(Odometry, walksWithTheRootOfDistanceWhateverSpeedAndStep) {
  OdometryModel model = exactModel();
  model.position_per_metre_m = 0.01;
  for (const double speed_mps : {0.2, 0.8}) {
    const Eigen::Vector3d squares = meanSquares(model, {speed_mps, 0.0, 0.0}, 1.6 / speed_mps);
    EXPECT_NEAR(squares.x() / (1e-4 * 1.6), 1.0, kTolerance) << speed_mps;
    EXPECT_NEAR(squares.y() / (1e-4 * 1.6), 1.0, kTolerance) << speed_mps;
  }
  const Eigen::Vector3d coarse = meanSquares(model, {0.8, 0.0, 0.0}, 2.0, 0.01);
  EXPECT_NEAR(coarse.x() / (1e-4 * 1.6), 1.0, kTolerance);
}

// The heading after s metres has the variance k^2 s; its integral moves the robot sideways by
// k^2 s^3 / 3.
TEST(Odometry, headingWalksAndSwingsThePositionAround) {
  OdometryModel model = exactModel();
  model.yaw_per_metre_rad = 0.01;
  const double metres = 3.0;
  const Eigen::Vector3d squares = meanSquares(model, {0.6, 0.0, 0.0}, metres / 0.6);
  EXPECT_NEAR(squares.z() / (1e-4 * metres), 1.0, kTolerance);
  EXPECT_NEAR(squares.y() / (1e-4 * std::pow(metres, 3) / 3.0), 1.0, kTolerance);
}

TEST(Odometry, walksWithTheRootOfTurns) {
  OdometryModel model = exactModel();
  model.yaw_per_turn_rad = 0.03;
  model.position_per_turn_m = 0.004;
  const Eigen::Vector3d squares = meanSquares(model, {0.0, 0.0, -M_PI}, 4.0);  // Two turns.
  EXPECT_NEAR(squares.z() / (2.0 * 9e-4), 1.0, kTolerance);
  EXPECT_NEAR(squares.head<2>().sum() / (2.0 * 2.0 * 1.6e-5), 1.0, kTolerance);
}

TEST(Odometry, poseIsTheIntegralOfTheTwistItReports) {
  Odometry odometry(OdometryModel(), true, Random(4));
  Pose2 integral;
  for (int i = 0; i < 2400; ++i) {
    const Twist2 twist{0.4, 0.1, 0.3};
    odometry.update(kStep_s, kStep_s * Eigen::Vector3d(0.4, 0.1, 0.3), twist);
    const Twist2& u = odometry.twist();
    integral = integral * expSe2(kStep_s * Eigen::Vector3d(u.vx_mps, u.vy_mps, u.wz_rps));
  }
  EXPECT_LT(distance(odometry.odom_T_robot(), integral), 1e-9);
  EXPECT_GT(distance(odometry.odom_T_robot(), expSe2({4.0, 1.0, 3.0})), 1e-3);
}

}  // namespace
}  // namespace casepush::sim
