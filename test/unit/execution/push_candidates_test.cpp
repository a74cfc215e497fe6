#include "../../../src/execution/push_candidates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../../src/execution/coverage.h"
#include "casepush/world/collision_checker.h"
#include "execution/fake_world.h"

namespace casepush {
namespace {

PlacedShape boxAt(const Eigen::Vector3d& size, const Eigen::Vector3d& centre) {
  PlacedShape shape{Box{size}, Eigen::Isometry3d::Identity(), "part"};
  shape.frame_T_shape.translation() = centre;
  return shape;
}

// A table: the robot's low base fits under it, its tall body does not.
Solid table() {
  return {boxAt({0.8, 0.5, 0.04}, {0.0, 0.0, 0.72}), boxAt({0.05, 0.05, 0.7}, {-0.3, 0.0, 0.35})};
}

Solid tallRobot() {
  Solid robot = test::disc(0.15);
  PlacedShape base{Cylinder{0.33, 0.3}, Eigen::Isometry3d::Identity(), "base"};
  base.frame_T_shape.translation().z() = 0.15;
  robot.push_back(base);
  return robot;
}

TEST(ContactStart, twoDiscsTouchWhereGeometrySays) {
  for (const double offset : {-0.4, -0.1, 0.0, 0.25}) {
    for (const double direction : {-2.0, 0.0, 1.3}) {
      const auto start =
          contactStart(test::disc(0.35), test::disc(0.3), 0.65, direction, offset, 0.03);
      ASSERT_TRUE(start);
      const Pose2 on_line = Pose2(0.0, 0.0, direction).inverse() * *start;
      // The robot may be 2 cm beside the line: contact comes first on the side of the centre.
      const double nearest = std::max(0.0, std::abs(offset) - 0.02);
      EXPECT_NEAR(on_line.x(), -std::sqrt(0.65 * 0.65 - nearest * nearest) - 0.03, 2e-3);
      EXPECT_NEAR(on_line.y(), offset, 1e-9);
      EXPECT_NEAR(start->yaw(), direction, 1e-9);
    }
  }
}

TEST(ContactStart, findsNothingWhereTheRobotPasses) {
  EXPECT_FALSE(contactStart(test::disc(0.35), test::disc(0.3), 0.65, 0.3, 0.7, 0.03));
}

TEST(ContactStart, usesTheTrueShapesAtEachHeight) {
  for (double direction = -3.1; direction < 3.1; direction += 0.2) {
    const auto start = contactStart(table(), tallRobot(), 1.0, direction, 0.0, 0.03);
    ASSERT_TRUE(start);
    EXPECT_FALSE(solidsOverlap(table(), Pose2(), tallRobot(), *start));
    const Pose2 ahead = *start * Pose2(0.03 + 0.03, 0.0, 0.0);
    EXPECT_TRUE(solidsOverlap(table(), Pose2(), tallRobot(), ahead)) << "direction " << direction;
  }
  // From the side the base goes under the table top until the body meets its edge.
  const auto side = contactStart(table(), tallRobot(), 1.0, M_PI / 2, 0.0, 0.03);
  EXPECT_NEAR(side->y(), -0.25 - 0.15 - 0.03, 3e-3);
}

TEST(PushCandidates, areWithinTheOptionsAndClearOfTheObject) {
  ExplorationOptions options;
  const ObjectModel object = test::fakeObject();
  const RobotModel robot = test::fakeRobot();
  const PushCandidates candidates(object, robot, options);
  std::vector<Pose2> outcomes;
  int turns[3] = {};
  for (int i = 0; i < 60; ++i) {
    const PushConfiguration push = candidates.draw(i, 0, outcomes);
    EXPECT_GE(push.speed_mps, options.min_speed_mps);
    EXPECT_LE(push.speed_mps, options.max_speed_mps);
    EXPECT_GE(push.duration_s, options.min_duration_s);
    EXPECT_LE(push.duration_s, options.max_duration_s);
    EXPECT_FALSE(solidsOverlap(object.solid, Pose2(), robot.solid, push.object_T_robot));
    EXPECT_NO_THROW(pushTrajectory(push, robot.limits, 0.1));
    ++turns[push.yaw_rate_rps > 0.0 ? 0 : push.yaw_rate_rps < 0.0 ? 2 : 1];
    if (i % 5 == 4) {
      const double direction = push.object_T_robot.yaw();
      outcomes.emplace_back(0.5 * std::cos(direction), 0.5 * std::sin(direction),
                            push.yaw_rate_rps == 0.0 ? 0.0 : std::copysign(0.6, push.yaw_rate_rps));
    }
  }
  for (const int count : turns) {
    EXPECT_GE(count, 10);
  }
  EXPECT_LT(directionGaps(outcomes).front().width_rad, 1.2);
}

TEST(PushCandidates, dependOnSeedAndAttemptOnly) {
  ExplorationOptions options;
  const PushCandidates a(test::fakeObject(), test::fakeRobot(), options);
  const PushCandidates b(test::fakeObject(), test::fakeRobot(), options);
  EXPECT_DOUBLE_EQ(a.draw(3, 0, {}).speed_mps, b.draw(3, 0, {}).speed_mps);
  EXPECT_NE(a.draw(3, 0, {}).speed_mps, a.draw(4, 0, {}).speed_mps);
  options.seed = 2;
  const PushCandidates c(test::fakeObject(), test::fakeRobot(), options);
  EXPECT_NE(a.draw(3, 0, {}).speed_mps, c.draw(3, 0, {}).speed_mps);
}

TEST(Coverage, gapsWrapAround) {
  EXPECT_NEAR(directionGaps({}).front().width_rad, 2.0 * M_PI, 1e-12);
  EXPECT_NEAR(directionGaps({Pose2(0.01, 0.0, 1.0)}).front().width_rad, 2.0 * M_PI, 1e-12);
  const auto gaps = directionGaps({Pose2(1, 0, 0), Pose2(0, 1, 0), Pose2(-1, 1e-9, 0)});
  ASSERT_EQ(gaps.size(), 3u);
  EXPECT_NEAR(gaps[0].width_rad, M_PI, 1e-6);
  EXPECT_NEAR(gaps[1].width_rad, M_PI / 2, 1e-6);
}

TEST(Coverage, sigmaIsUnbiasedAndAlongTheLongestAxis) {
  PoseGaussian outcome;
  // Standard deviations 0.2 and 0.1, turned by 45 degrees.
  outcome.covariance << 0.025, 0.015, 0.0, 0.015, 0.025, 0.0, 0.0, 0.0, 0.09;
  const OutcomeSigma sigma = outcomeSigma(outcome, 5.0);
  EXPECT_NEAR(sigma.position_m, 0.2 * std::sqrt(1.25), 1e-9);
  EXPECT_NEAR(sigma.yaw_rad, 0.3 * std::sqrt(1.25), 1e-9);
}

TEST(Coverage, noticesThatTheRobotPassedTheObject) {
  Case push_case;
  for (int i = 0; i <= 10; ++i) {
    CaseStep step;
    step.object_T_robot = Pose2(-0.7 + 0.05 * i, 0.0, 0.0);
    push_case.steps.push_back(step);
  }
  push_case.push_steps = 11;
  EXPECT_FALSE(hasLostContact(push_case));
  for (CaseStep& step : push_case.steps) {
    step.object_T_robot = Pose2(step.object_T_robot.x() + 0.3, -0.66, 0.0);
  }
  EXPECT_TRUE(hasLostContact(push_case));
}

}  // namespace
}  // namespace casepush
