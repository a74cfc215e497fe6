#include "casepush/planning/prepared_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

constexpr double kObjectRadius_m = 0.35;
constexpr double kRobotRadius_m = 0.3;

PreparedCase prepared(const Case& push_case, double zeta, double step_m) {
  return prepareCases({push_case}, zeta, step_m, kObjectRadius_m, kRobotRadius_m).front();
}

// Largest motion of any point of the body from a pose of the trajectory to the nearest one kept.
double largestGap(const std::vector<Pose2>& kept, const Case& push_case) {
  double worst = 0.0;
  for (double t = 0.0; t <= 1.0; t += 0.002) {
    const double at = t * static_cast<double>(push_case.steps.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), push_case.steps.size() - 2);
    const Pose2 pose =
        interpolate(push_case.steps[i].start_T_object, push_case.steps[i + 1].start_T_object,
                    at - static_cast<double>(i));
    double nearest = 1e9;
    for (const Pose2& other : kept) {
      nearest = std::min(
          nearest, distance(pose, other) + kObjectRadius_m * std::abs(yawDifference(pose, other)));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(PrepareCases, leavesNoGapInTheTrajectoryWhateverTheSampling) {
  for (const double step_m : {0.01, 0.025, 0.05, 0.2}) {
    const Case push_case = syntheticPush(1, 0.4, 2.5, 1.2, {});
    const PreparedCase result = prepared(push_case, 3.0, step_m);
    EXPECT_LE(largestGap(result.start_T_object, push_case), step_m) << step_m;
  }
}

TEST(PrepareCases, checksTheLastPoseFirst) {
  const Case push_case = syntheticPush(1, 0.4, 2.5, 1.2, {});
  const PreparedCase result = prepared(push_case, 3.0, 0.025);
  EXPECT_NEAR(distance(result.start_T_object.front(), push_case.steps.back().start_T_object), 0.0,
              1e-9);
  EXPECT_NEAR(distance(result.start_T_robot.front(), push_case.steps.back().start_T_robot()), 0.0,
              1e-9);
}

TEST(PrepareCases, thinsOutWhatIsDenserThanNeeded) {
  SyntheticPushOptions slow;
  slow.speed_mps = 0.02;
  const PreparedCase result = prepared(syntheticPush(1, 0.0, 3.0, 0.0, slow), 3.0, 0.03);
  EXPECT_LE(result.start_T_object.size(), 4U);  // 6 cm in steps of 3 cm.
}

TEST(PrepareCases, spreadsSigmaPointsByZeta) {
  const Case push_case = syntheticPush(1, 0.0, 2.0, 0.0, {});
  EXPECT_TRUE(prepared(push_case, 0.0, 0.05).start_T_sigma.empty());
  const PreparedCase result = prepared(push_case, 2.0, 0.05);
  ASSERT_EQ(result.start_T_sigma.size(), 6U);
  double farthest = 0.0;
  for (const Pose2& pose : result.start_T_sigma) {
    farthest = std::max(farthest, distance(pose, push_case.start_outcome.mean));
  }
  EXPECT_NEAR(farthest, 2.0 * 0.03, 1e-9);
}

TEST(PrepareCases, keepsTheRobotAtTheSideOfTheRestingObject) {
  Case push_case = syntheticPush(1, 0.3, 2.0, 0.5, {});
  // Practices moved the mean away from where the first push ended.
  push_case.start_outcome.mean = push_case.start_outcome.mean * Pose2(0.1, 0.05, 0.2);
  const PreparedCase result = prepared(push_case, 3.0, 0.05);
  EXPECT_NEAR(distance(result.outcome_T_robot, push_case.steps.back().object_T_robot), 0.0, 1e-12);
}

TEST(PushDirection, isThatOfTheFirstMotionInTheStartFrame) {
  const Case push_case = syntheticPush(1, 0.7, 2.0, 0.0, {});
  EXPECT_NEAR(pushDirection(push_case), 0.7, 1e-9);
}

TEST(PushDirection, isNotMisledByCorrectionsAtTheStart) {
  Case push_case = syntheticPush(1, 0.7, 2.0, 0.0, {});
  // The robot first corrects its heading and slips aside by a centimetre.
  push_case.steps[0].action = Twist2{0.0, 0.1, 0.0};
  CaseStep& second = push_case.steps[1];
  second.object_T_robot = second.object_T_robot * Pose2(0.0, 0.01, 0.0);
  EXPECT_NEAR(pushDirection(push_case), 0.7, 0.15);
}

TEST(PushDirection, pointsToTheObjectWhenTheRobotOnlyTurns) {
  Case push_case = syntheticPush(1, -2.0, 2.0, 0.0, {});
  for (CaseStep& step : push_case.steps) {
    step.action = Twist2{0.0, 0.0, 0.5};
    step.start_T_object = Pose2();
    step.object_T_robot = Pose2(push_case.steps.front().object_T_robot.x(),
                                push_case.steps.front().object_T_robot.y(), 0.0);
  }
  EXPECT_NEAR(pushDirection(push_case), -2.0, 1e-9);
}

}  // namespace
}  // namespace casepush
