#include "../../../src/execution/rest_of_plan.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

constexpr double kSigmaM = 0.05;
constexpr double kSigmaRad = 0.05;

// A rest of `count` pushes of half a metre along x whose mean ends `miss_m` beside the goal.
PushPlanner::Continuation restOf(int count, double miss_m) {
  PushPlanner::Continuation rest;
  rest.chained = true;
  rest.applicable = count;
  Pose2 pose;
  for (int i = 0; i < count; ++i) {
    PlannedPush push;
    push.map_T_start = pose;
    pose = pose * Pose2(0.5, 0.0, 0.0);
    push.map_outcome.mean = pose;
    push.map_outcome.covariance =
        Eigen::Vector3d(kSigmaM, kSigmaM, kSigmaRad).cwiseAbs2().asDiagonal();
    rest.plan.pushes.push_back(push);
  }
  rest.plan.map_T_goal = pose * Pose2(0.0, miss_m, 0.0);
  rest.valid = rest.plan.tolerance.isMet(rest.plan.map_T_goal, pose);
  rest.explanation = rest.valid ? "" : "it ends beside the goal";
  return rest;
}

TEST(JudgeRest, goesOnAsLongAsTheMissIsSmallAgainstTheScatterAhead) {
  const RestOptions options;
  EXPECT_TRUE(judgeRest(restOf(12, 0.0), options).goes_on);
  EXPECT_TRUE(judgeRest(restOf(12, 0.5), options).goes_on);
  const RestVerdict hopeless = judgeRest(restOf(12, 4.0), options);
  EXPECT_FALSE(hopeless.goes_on);
  EXPECT_EQ(hopeless.cause, ReplanCause::kRestMissesGoal);
  EXPECT_EQ(hopeless.why, "it ends beside the goal");
}

TEST(JudgeRest, isStricterTheNearerTheGoal) {
  const RestOptions options;
  EXPECT_TRUE(judgeRest(restOf(1, 0.15), options).goes_on);
  EXPECT_FALSE(judgeRest(restOf(1, 0.4), options).goes_on);
  EXPECT_TRUE(judgeRest(restOf(6, 0.4), options).goes_on);
}

TEST(JudgeRest, strictRuleGivesUpEveryMiss) {
  RestOptions options;
  options.rule = RestRule::kMeanAtGoal;
  EXPECT_TRUE(judgeRest(restOf(12, 0.1), options).goes_on);
  EXPECT_FALSE(judgeRest(restOf(12, 0.5), options).goes_on);
}

TEST(JudgeRest, givesUpWhatMayGetTheObjectStuck) {
  PushPlanner::Continuation rest = restOf(3, 0.0);
  rest.may_get_stuck = true;
  const RestVerdict verdict = judgeRest(rest, RestOptions());
  EXPECT_FALSE(verdict.goes_on);
  EXPECT_EQ(verdict.cause, ReplanCause::kDeadEndAhead);
}

TEST(JudgeRest, caresForCollisionsOfTheNextPushesOnly) {
  RestOptions options;
  options.horizon = 3;
  PushPlanner::Continuation rest = restOf(6, 0.0);
  rest.valid = false;
  rest.explanation = "push 4: it would hit a wall";
  rest.applicable = 3;
  EXPECT_TRUE(judgeRest(rest, options).goes_on);
  rest.applicable = 2;
  const RestVerdict blocked = judgeRest(rest, options);
  EXPECT_FALSE(blocked.goes_on);
  EXPECT_EQ(blocked.cause, ReplanCause::kRestCollides);
  EXPECT_EQ(blocked.why, rest.explanation);
  PushPlanner::Continuation last = restOf(2, 0.0);
  last.valid = false;
  last.applicable = 1;
  EXPECT_FALSE(judgeRest(last, options).goes_on) << "the horizon is longer than the rest";
}

TEST(JudgeRest, givesUpARestWithACaseThatIsGone) {
  PushPlanner::Continuation rest = restOf(9, 0.0);
  rest.valid = false;
  rest.chained = false;
  rest.applicable = 8;
  EXPECT_EQ(judgeRest(rest, RestOptions{}).cause, ReplanCause::kRestCollides);
}

}  // namespace
}  // namespace casepush
