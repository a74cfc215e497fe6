#include "localisation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace casepush::sim {
namespace {

constexpr double kStep_s = 1.0 / 240.0;

LocalisationModel makeModel(double sigma_m, double sigma_rad, double correlation_s) {
  LocalisationModel model;
  model.position_sigma_m = sigma_m;
  model.yaw_sigma_rad = sigma_rad;
  model.correlation_s = correlation_s;
  model.position_bound_m = 10.0 * sigma_m;
  model.yaw_bound_rad = 10.0 * sigma_rad;
  return model;
}

Pose2 estimateOf(const OdometryReading& reading) {
  return reading.map_T_odom * reading.odom_T_robot;
}

std::vector<Eigen::Vector3d> sample(PoseError error, int count, double step_s) {
  std::vector<Eigen::Vector3d> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back(error.value());
    error.update(step_s);
  }
  return samples;
}

Eigen::Vector3d meanProduct(const std::vector<Eigen::Vector3d>& samples, std::size_t lag) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = lag; i < samples.size(); ++i) {
    sum += samples[i].cwiseProduct(samples[i - lag]);
  }
  return sum / static_cast<double>(samples.size() - lag);
}

// Ornstein-Uhlenbeck: the covariance of errors a time t apart is sigma^2 exp(-t / tau).
TEST(PoseError, hasTheVarianceAndTheAutocorrelationOfItsModel) {
  const LocalisationModel model = makeModel(0.02, 0.01, 2.0);
  const auto samples = sample(PoseError(model, true, Random(5)), 200000, 0.5);
  const Eigen::Vector3d sigma(0.02, 0.02, 0.01);
  for (const std::size_t lag : {0U, 2U, 4U, 8U}) {
    const Eigen::Vector3d covariance = meanProduct(samples, lag);
    for (int i = 0; i < 3; ++i) {
      // 200000 samples hold some 50000 independent ones: 4 standard deviations.
      EXPECT_NEAR(covariance[i] / (sigma[i] * sigma[i]), std::exp(-0.5 * lag / 2.0), 0.025)
          << "axis " << i << ", lag " << lag;
    }
  }
}

TEST(PoseError, startsFromTheStationaryLawAndDoesNotDependOnTheStep) {
  const LocalisationModel model = makeModel(0.02, 0.01, 2.0);
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d later = Eigen::Vector3d::Zero();
  constexpr int kRuns = 4000;
  for (int seed = 0; seed < kRuns; ++seed) {
    PoseError error(model, true, Random(static_cast<std::uint64_t>(seed)));
    first += error.value().cwiseAbs2() / kRuns;
    for (int i = 0; i < 24; ++i) error.update(kStep_s * (seed % 2 == 0 ? 1.0 : 40.0));
    later += error.value().cwiseAbs2() / kRuns;
  }
  for (const Eigen::Vector3d& variance : {first, later}) {
    EXPECT_NEAR(variance.x(), 4e-4, 4e-5);
    EXPECT_NEAR(variance.y(), 4e-4, 4e-5);
    EXPECT_NEAR(variance.z(), 1e-4, 1e-5);
  }
}

// The length r of the position's error is Rayleigh distributed; cut off at b,
// E[min(r, b)^2] = 2 sigma^2 (1 - exp(-b^2 / (2 sigma^2))).
TEST(PoseError, keepsWithinItsBoundsAndHasTheVarianceThatTheyLeave) {
  LocalisationModel model = makeModel(0.02, 0.01, 1.0);
  model.position_bound_m = 0.03;
  model.yaw_bound_rad = 0.015;
  double squares = 0.0;
  double yaw_at_bound = 0.0;
  const auto samples = sample(PoseError(model, true, Random(3)), 100000, 1.0);
  for (const Eigen::Vector3d& error : samples) {
    ASSERT_LE(error.head<2>().norm(), 0.03 + 1e-12);
    ASSERT_LE(std::abs(error.z()), 0.015);
    squares += error.head<2>().squaredNorm();
    yaw_at_bound += std::abs(error.z()) >= 0.015 ? 1.0 : 0.0;
  }
  const double count = static_cast<double>(samples.size());
  const double expected = 2.0 * 4e-4 * (1.0 - std::exp(-0.5 * 1.5 * 1.5));
  EXPECT_NEAR(squares / count, expected, 0.02 * expected);
  EXPECT_NEAR(yaw_at_bound / count, std::erfc(1.5 / std::sqrt(2.0)), 0.006);
}

TEST(Localisation, isExactWithoutNoise) {
  for (const bool globally : {true, false}) {
    RobotModel robot;
    robot.odometry.switches.noise = robot.localisation.switches.noise = globally;
    Localisation localisation(robot, !globally, 1, Pose2(1.0, 2.0, 0.3));
    Pose2 pose(1.0, 2.0, 0.3);
    for (int i = 0; i < 1000; ++i) {
      pose = pose * Pose2(0.002, 0.0, 0.003);
      localisation.update(kStep_s, pose, {0.5, 0.0, 0.7});
    }
    const OdometryReading reading = localisation.reading(4.0);
    EXPECT_LT(distance(estimateOf(reading), pose), 1e-9);
    EXPECT_NEAR(wrapAngle(estimateOf(reading).yaw() - pose.yaw()), 0.0, 1e-9);
    EXPECT_LT(distance(reading.odom_T_robot, Pose2(1.0, 2.0, 0.3).inverse() * pose), 1e-9);
    EXPECT_DOUBLE_EQ(reading.robot_twist.wz_rps, 0.7);
    EXPECT_DOUBLE_EQ(reading.stamp_s, 4.0);
  }
}

TEST(Localisation, correctsTheDriftOfTheWheels) {
  const RobotModel robot;
  Localisation localisation(robot, true, 1, Pose2());
  Pose2 pose;
  for (int i = 0; i < 240 * 60; ++i) {
    pose = pose * Pose2(0.002, 0.0, 0.0);
    localisation.update(kStep_s, pose, {0.48, 0.0, 0.0});
    const Pose2 estimate = estimateOf(localisation.reading(0.0));
    ASSERT_LE(distance(estimate, pose), robot.localisation.position_bound_m + 1e-9);
    ASSERT_LE(std::abs(wrapAngle(estimate.yaw() - pose.yaw())),
              robot.localisation.yaw_bound_rad + 1e-9);
  }
  EXPECT_GT(distance(localisation.reading(60.0).odom_T_robot, pose), 0.01);
}

// Each has a stream of its own: making one exact leaves the other as it was.
TEST(Localisation, errorsOfOdometryAndOfLocalisationAreIndependent) {
  const auto run = [](bool odometry_noise, bool localisation_noise) {
    RobotModel robot;
    robot.odometry.switches.noise = odometry_noise;
    robot.localisation.switches.noise = localisation_noise;
    Localisation localisation(robot, true, 1, Pose2());
    for (int i = 1; i <= 480; ++i) {
      localisation.update(kStep_s, Pose2(0.002 * i, 0.0, 0.0), {0.48, 0.0, 0.0});
    }
    return localisation.reading(2.0);
  };
  const OdometryReading both = run(true, true);
  EXPECT_EQ(run(true, false).odom_T_robot.x(), both.odom_T_robot.x());
  EXPECT_NEAR(estimateOf(run(false, true)).x(), estimateOf(both).x(), 1e-12);
  EXPECT_NE(run(false, true).odom_T_robot.x(), both.odom_T_robot.x());
  EXPECT_NEAR(estimateOf(run(true, false)).x(), 0.96, 1e-9);
}

TEST(Localisation, followsARobotThatIsPutElsewhere) {
  Localisation localisation(RobotModel(), true, 1, Pose2());
  const Pose2 odom_T_robot = localisation.reading(0.0).odom_T_robot;
  localisation.relocate(Pose2(3.0, 1.0, 1.0));
  const OdometryReading reading = localisation.reading(0.0);
  EXPECT_EQ(reading.odom_T_robot.x(), odom_T_robot.x());
  EXPECT_LT(distance(estimateOf(reading), Pose2(3.0, 1.0, 1.0)), 0.0121);
  EXPECT_EQ(reading.robot_twist.speed(), 0.0);
}

}  // namespace
}  // namespace casepush::sim
