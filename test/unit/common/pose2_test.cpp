#include "casepush/common/pose2.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr double kTolerance = 1e-12;
constexpr int kTrials = 500;

Pose2 randomPose(Random* random) {
  return {random->uniform(-10, 10), random->uniform(-10, 10), random->uniform(-M_PI, M_PI)};
}

void expectSame(const Pose2& a, const Pose2& b, double tolerance = 1e-11) {
  EXPECT_NEAR(a.x(), b.x(), tolerance);
  EXPECT_NEAR(a.y(), b.y(), tolerance);
  EXPECT_NEAR(yawDifference(a, b), 0.0, tolerance);
}

TEST(WrapAngle, mapsToTheHalfOpenInterval) {
  EXPECT_EQ(wrapAngle(M_PI), M_PI);
  EXPECT_EQ(wrapAngle(-M_PI), M_PI);
  EXPECT_NEAR(wrapAngle(3.0 * M_PI), M_PI, kTolerance);
  EXPECT_NEAR(wrapAngle(-3.5 * M_PI), 0.5 * M_PI, kTolerance);
  EXPECT_EQ(wrapAngle(0.3), 0.3);
  for (double angle_rad = -20.0; angle_rad < 20.0; angle_rad += 0.01) {
    const double wrapped = wrapAngle(angle_rad);
    EXPECT_GT(wrapped, -M_PI);
    EXPECT_LE(wrapped, M_PI);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle_rad), kTolerance);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle_rad), kTolerance);
  }
}

TEST(Pose2, isAGroup) {
  Random random(1);
  for (int i = 0; i < kTrials; ++i) {
    const Pose2 a = randomPose(&random);
    const Pose2 b = randomPose(&random);
    const Pose2 c = randomPose(&random);
    expectSame((a * b) * c, a * (b * c));
    expectSame(a * a.inverse(), Pose2());
    expectSame(a.inverse() * a, Pose2());
    expectSame(a * Pose2(), a);
    expectSame(Pose2() * a, a);
    expectSame((a * b).inverse(), b.inverse() * a.inverse());
  }
}

TEST(Pose2, mapsPointsLikeItComposes) {
  const Pose2 map_T_robot(1.0, 2.0, M_PI / 2);
  const Eigen::Vector2d map_p = map_T_robot * Eigen::Vector2d(3.0, 0.0);
  EXPECT_NEAR(map_p.x(), 1.0, kTolerance);
  EXPECT_NEAR(map_p.y(), 5.0, kTolerance);
  expectSame(map_T_robot * Pose2(3.0, 0.0, 0.1), Pose2(1.0, 5.0, M_PI / 2 + 0.1));
}

TEST(Pose2, composesHeadingsAcrossPi) {
  const Pose2 pose = Pose2(0, 0, 3.0) * Pose2(0, 0, 3.0);
  EXPECT_NEAR(pose.yaw(), 6.0 - 2.0 * M_PI, kTolerance);
  EXPECT_NEAR(yawDifference(Pose2(0, 0, 3.1), Pose2(0, 0, -3.1)), 2.0 * M_PI - 6.2, kTolerance);
}

TEST(Pose2, knowsWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Pose2(1, 2, 3).isFinite());
  EXPECT_FALSE(Pose2(nan, 0, 0).isFinite());
  EXPECT_FALSE(Pose2(0, infinity, 0).isFinite());
  EXPECT_FALSE(Pose2(0, 0, nan).isFinite());
  EXPECT_FALSE(Pose2(0, 0, infinity).isFinite());
  EXPECT_TRUE((Twist2{1, 2, 3}).isFinite());
  EXPECT_FALSE((Twist2{1, nan, 3}).isFinite());
  EXPECT_FALSE((Twist2{1, 2, infinity}).isFinite());
}

TEST(LogSe2, isTheInverseOfExpAlsoNearZeroAndNearPi) {
  Random random(2);
  std::vector<double> yaws{0.0,  1e-12, -1e-9, 1e-7,        -1e-6,       1e-6,
                           1e-5, 1e-3,  -0.1,  M_PI - 1e-6, 1e-6 - M_PI, M_PI - 1e-12};
  for (int i = 0; i < kTrials; ++i) {
    yaws.push_back(random.uniform(-M_PI, M_PI));
  }
  for (const double yaw_rad : yaws) {
    const Pose2 pose(random.uniform(-5, 5), random.uniform(-5, 5), yaw_rad);
    expectSame(expSe2(logSe2(pose)), pose);
    const Eigen::Vector3d tangent(random.uniform(-5, 5), random.uniform(-5, 5), yaw_rad);
    EXPECT_LT((logSe2(expSe2(tangent)) - tangent).norm(), 1e-9) << "yaw " << yaw_rad;
  }
}

TEST(ExpSe2, drivesAQuarterCircle) {
  // Speed pi/2 m/s and yaw rate pi/2 rad/s for 1 s: a quarter of a circle of radius 1 m.
  expectSame(expSe2({M_PI / 2, 0.0, M_PI / 2}), Pose2(1.0, 1.0, M_PI / 2));
}

TEST(ExpSe2, agreesWithIntegration) {
  const Eigen::Vector3d tangent(0.7, -0.4, 2.1);
  constexpr int kSteps = 1000000;
  Pose2 pose;
  for (int i = 0; i < kSteps; ++i) {
    pose = pose * Pose2(tangent.x() / kSteps, tangent.y() / kSteps, tangent.z() / kSteps);
  }
  expectSame(pose, expSe2(tangent), 2e-6);
}

TEST(AdjointSe2, movesTangentsBetweenFrames) {
  Random random(3);
  for (int i = 0; i < kTrials; ++i) {
    const Pose2 pose = randomPose(&random);
    const Eigen::Vector3d tangent(random.uniform(-1, 1), random.uniform(-1, 1),
                                  random.uniform(-1, 1));
    expectSame(expSe2(adjointSe2(pose) * tangent), pose * expSe2(tangent) * pose.inverse(), 1e-10);
  }
}

TEST(Interpolate, followsTheScrewFromEndToEnd) {
  Random random(4);
  for (int i = 0; i < kTrials; ++i) {
    const Pose2 a = randomPose(&random);
    const Pose2 b = randomPose(&random);
    expectSame(interpolate(a, b, 0.0), a);
    expectSame(interpolate(a, b, 1.0), b);
    const Pose2 middle = interpolate(a, b, 0.5);
    EXPECT_LT((logSe2(a.inverse() * middle) - logSe2(middle.inverse() * b)).norm(), 1e-9);
  }
}

TEST(Rotate, keepsSpeedAndYawRate) {
  const Twist2 map_twist = rotate(Twist2{0.3, 0.0, 0.7}, M_PI / 2);
  EXPECT_NEAR(map_twist.vx_mps, 0.0, kTolerance);
  EXPECT_NEAR(map_twist.vy_mps, 0.3, kTolerance);
  EXPECT_EQ(map_twist.wz_rps, 0.7);
  EXPECT_NEAR(map_twist.speed(), 0.3, kTolerance);
}

}  // namespace
}  // namespace casepush
