#include "localisation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace casepush::sim {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

Eigen::Vector3d errorOf(const OdometryReading& reading, const Pose2& truth) {
  return logSe2(truth.inverse() * (reading.map_T_odom * reading.odom_T_robot));
}

TEST(Localisation, isExactWithoutNoise) {
  SimulatorOptions options;
  options.sensor_noise = false;
  Localisation localisation(options, Pose2(1.0, 2.0, 0.3));
  Pose2 pose(1.0, 2.0, 0.3);
  for (int i = 0; i < 1000; ++i) {
    pose = pose * Pose2(0.002, 0.0, 0.003);
    localisation.update(kStep_s, pose, {0.5, 0.0, 0.7});
  }
  const OdometryReading reading = localisation.reading(4.0);
  EXPECT_LT(errorOf(reading, pose).norm(), 1e-9);
  EXPECT_DOUBLE_EQ(reading.robot_twist.wz_rps, 0.7);
  EXPECT_DOUBLE_EQ(reading.stamp_s, 4.0);
}

TEST(Localisation, errorIsBoundedCorrelatedAndOfTheGivenSize) {
  SimulatorOptions options;
  options.localisation_sigma_m = 0.01;
  options.localisation_sigma_rad = 0.004;
  options.localisation_correlation_s = 2.0;
  Localisation localisation(options, Pose2());
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d products = Eigen::Vector3d::Zero();  // With the error one correlation time ago.
  Eigen::Vector3d before = errorOf(localisation.reading(0.0), Pose2());
  const int samples = 4000;
  for (int i = 0; i < samples; ++i) {
    for (int k = 0; k < 20; ++k) localisation.update(0.1, Pose2(), {});
    const Eigen::Vector3d error = errorOf(localisation.reading(0.0), Pose2());
    squares += error.cwiseAbs2();
    products += error.cwiseProduct(before);
    before = error;
    EXPECT_LE(std::abs(error.x()), 0.0301);
    EXPECT_LE(std::abs(error.z()), 0.0121);
  }
  EXPECT_NEAR(std::sqrt(squares.x() / samples), 0.01, 0.001);
  EXPECT_NEAR(std::sqrt(squares.z() / samples), 0.004, 0.0004);
  EXPECT_NEAR(products.x() / squares.x(), std::exp(-1.0), 0.1);
}

TEST(Localisation, correctsTheDriftOfTheWheels) {
  SimulatorOptions options;
  Localisation localisation(options, Pose2());
  Pose2 pose;
  for (int i = 0; i < 240 * 60; ++i) {
    pose = pose * Pose2(0.002, 0.0, 0.0);
    localisation.update(kStep_s, pose, {0.48, 0.0, 0.0});
  }
  const OdometryReading reading = localisation.reading(60.0);
  EXPECT_GT(std::abs(reading.odom_T_robot.x() - pose.x()), 0.01);
  EXPECT_LT(errorOf(reading, pose).norm(), 0.02);
}

TEST(Localisation, followsARobotThatIsPutElsewhere) {
  SimulatorOptions options;
  Localisation localisation(options, Pose2());
  const Pose2 odom_T_robot = localisation.reading(0.0).odom_T_robot;
  localisation.relocate(Pose2(3.0, 1.0, 1.0));
  const OdometryReading reading = localisation.reading(0.0);
  EXPECT_EQ(reading.odom_T_robot.x(), odom_T_robot.x());
  EXPECT_LT(errorOf(reading, Pose2(3.0, 1.0, 1.0)).norm(), 0.03);
}

}  // namespace
}  // namespace casepush::sim
