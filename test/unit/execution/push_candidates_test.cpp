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
  for (const CoverageStrategy strategy : {CoverageStrategy::kRandom, CoverageStrategy::kSpread}) {
    ExplorationOptions options;
    options.coverage = strategy;
    const ObjectModel object = test::fakeObject();
    const RobotModel robot = test::fakeRobot();
    const PushCandidates candidates(object, robot, options);
    for (int i = 0; i < 20; ++i) {
      const auto push = candidates.draw(i, {}, {});
      ASSERT_TRUE(push);
      EXPECT_GE(push->speed_mps, options.min_speed_mps);
      EXPECT_LE(push->speed_mps, options.max_speed_mps);
      EXPECT_GE(push->duration_s, options.min_duration_s);
      EXPECT_LE(push->duration_s, options.max_duration_s);
      EXPECT_FALSE(solidsOverlap(object.solid, Pose2(), robot.solid, push->object_T_robot));
      EXPECT_NO_THROW(pushTrajectory(*push, robot.limits, 0.1));
    }
  }
}

// What 14 pushes would cover if each went as predicted.
double coveredBy(CoverageStrategy strategy, std::vector<Pose2>& outcomes) {
  ExplorationOptions options;
  options.coverage = strategy;
  const PushCandidates candidates(test::fakeObject(), test::fakeRobot(), options);
  DisplacementCoverage coverage;
  for (int i = 0; i < 14; ++i) {
    const Pose2 next = candidates.predict(*candidates.draw(i, outcomes, {}));
    coverage.add(next);
    outcomes.push_back(next);
  }
  return coverage.meanDistance();
}

TEST(PushCandidates, spreadPushesCoverMoreThanRandomOnes) {
  std::vector<Pose2> random;
  std::vector<Pose2> spread;
  EXPECT_LT(coveredBy(CoverageStrategy::kSpread, spread),
            0.9 * coveredBy(CoverageStrategy::kRandom, random));
  EXPECT_LT(directionGaps(spread).front().width_rad, 1.6);
  int left = 0;
  int right = 0;
  for (const Pose2& outcome : spread) {
    left += turnOf(outcome) == Turn::kLeft ? 1 : 0;
    right += turnOf(outcome) == Turn::kRight ? 1 : 0;
  }
  EXPECT_GE(left, 4);
  EXPECT_GE(right, 4);
}

TEST(PushCandidates, obeyTheFilter) {
  const PushCandidates candidates(test::fakeObject(), test::fakeRobot(), ExplorationOptions{});
  const auto ahead = [](const PushConfiguration&, const Pose2& predicted) {
    return predicted.x() > 0.2;
  };
  const auto push = candidates.draw(0, {}, ahead);
  ASSERT_TRUE(push);
  EXPECT_GT(candidates.predict(*push).x(), 0.2);
  EXPECT_FALSE(candidates.draw(0, {}, [](const auto&, const auto&) { return false; }));
}

TEST(PushPredictor, aPushAtTheCentreMovesAndOneBesideItTurns) {
  const PushPredictor predictor(test::fakeObject(), test::fakeRobot());
  PushConfiguration push = test::straightPush();
  const double length_m = 0.3 * 2.0 - 0.3 * 0.3 / 0.8;
  EXPECT_NEAR(predictor.predict(push).x(), length_m, 1e-3);
  EXPECT_NEAR(predictor.predict(push).yaw(), 0.0, 1e-9);
  push.object_T_robot = Pose2(push.object_T_robot.x() + 0.05, -0.2, 0.0);
  EXPECT_GT(predictor.predict(push).yaw(), 0.2);
  push.object_T_robot = Pose2(push.object_T_robot.x(), 0.2, 0.0);
  EXPECT_LT(predictor.predict(push).yaw(), -0.2);
}

TEST(PushPredictor, learnsHowFarAnObjectGoes) {
  PushPredictor predictor(test::fakeObject(), test::fakeRobot());
  const PushConfiguration push = test::straightPush();
  const double before_m = predictor.predict(push).x();
  for (int i = 0; i < 10; ++i) {
    predictor.learn(push, Pose2(1.4 * before_m, 0.0, 0.0));
  }
  EXPECT_NEAR(predictor.predict(push).x(), 1.4 * before_m, 0.1 * before_m);
}

TEST(PushPredictor, knowsWhenTheRobotTurnsPastTheObject) {
  const PushPredictor predictor(test::fakeObject(), test::fakeRobot());
  PushConfiguration push = test::straightPush();
  EXPECT_FALSE(predictor.slidesOff(push));
  push.object_T_robot = Pose2(-0.6, 0.25, 0.0);
  push.yaw_rate_rps = 0.6;
  push.duration_s = 3.0;
  EXPECT_TRUE(predictor.slidesOff(push));
}

TEST(PushCandidates, dependOnSeedAndAttemptOnly) {
  ExplorationOptions options;
  const PushCandidates a(test::fakeObject(), test::fakeRobot(), options);
  const PushCandidates b(test::fakeObject(), test::fakeRobot(), options);
  EXPECT_DOUBLE_EQ(a.draw(3, {}, {})->speed_mps, b.draw(3, {}, {})->speed_mps);
  EXPECT_NE(a.draw(3, {}, {})->speed_mps, a.draw(4, {}, {})->speed_mps);
  options.seed = 2;
  const PushCandidates c(test::fakeObject(), test::fakeRobot(), options);
  EXPECT_NE(a.draw(3, {}, {})->speed_mps, c.draw(3, {}, {})->speed_mps);
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
