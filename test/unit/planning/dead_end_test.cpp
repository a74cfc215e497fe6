#include <gtest/gtest.h>

#include <cmath>

#include "planning/planner_fixture.h"

namespace casepush {
namespace {

constexpr double kPushM = 0.9;

/// Pushes of kPushM along the object's x axis (id 1), to its left and to its right.
std::vector<Case> pushes(int count) {
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    const double bearing_rad = i == 0 ? 0.0 : i == 1 ? M_PI_2 : -M_PI_2;
    cases.push_back(syntheticPush(i + 1, bearing_rad, 3.0, 0.0, {}));
  }
  return cases;
}

class DeadEndTest : public testing::Test {
 protected:
  /// Continues with one push along x from `x_m`; the room's wall begins at x = 14.9 m.
  PushPlanner::Continuation pushFrom(double x_m, int case_count, double goal_x_m,
                                     const std::vector<PlacedObject>& obstacles = {}) const {
    PushPlan plan;
    plan.object = {"chair_1", "chair", Pose2(x_m, 7.5, 0.0)};
    plan.map_T_goal = Pose2(goal_x_m, 7.5, 0.0);
    plan.zeta = 3.0;
    plan.pushes.push_back({1, plan.object.map_T_object, {}});
    return planner_->continuePlan(plan, plan.object.map_T_object, pushes(case_count), obstacles);
  }

  std::unique_ptr<PushPlanner> planner_ = plannerFor(emptyRoom(), quick());
};

TEST_F(DeadEndTest, isWhereNoCaseCanBeAppliedAfterThePush) {
  const auto at_the_wall = pushFrom(13.3, 1, 5.0);
  EXPECT_EQ(at_the_wall.applicable, 1) << at_the_wall.explanation;
  EXPECT_TRUE(at_the_wall.may_get_stuck);
  EXPECT_FALSE(pushFrom(5.0, 1, 14.0).may_get_stuck);
}

TEST_F(DeadEndTest, isAlsoWhereOnlyAFewPushesAreLeft) {
  EXPECT_TRUE(pushFrom(13.3 - 7 * kPushM, 1, 5.0).may_get_stuck);
  EXPECT_FALSE(pushFrom(13.3 - 8 * kPushM, 1, 5.0).may_get_stuck);
}

TEST_F(DeadEndTest, isNotWhereAnotherCaseLeadsAway) {
  EXPECT_FALSE(pushFrom(13.3, 3, 5.0).may_get_stuck);
}

TEST_F(DeadEndTest, isNotTheGoalUnlessThePushMayMissIt) {
  EXPECT_FALSE(pushFrom(13.3, 1, 14.2).may_get_stuck);
  EXPECT_TRUE(pushFrom(13.3, 1, 14.35).may_get_stuck);
}

TEST_F(DeadEndTest, objectsMakeOneToo) {
  const std::vector<PlacedObject> beyond = {{"chair_2", "chair", Pose2(7.3, 7.5, 0.0)}};
  EXPECT_TRUE(pushFrom(5.0, 1, 14.0, beyond).may_get_stuck);
}

TEST_F(DeadEndTest, aPushThatCannotBeAppliedIsNone) {
  const auto blocked = pushFrom(14.3, 1, 5.0);
  EXPECT_EQ(blocked.applicable, 0);
  EXPECT_FALSE(blocked.may_get_stuck);
}

TEST(FinerSearch, followsIfNodesThatAreFarApartLeadNowhere) {
  PushPlannerOptions coarse = quick();
  coarse.spacing_m = 0.8;
  coarse.relax = false;
  const PlanRequest request = requestFor(kStart, kGoal);
  const std::vector<Case> cases = syntheticPushes(14, 7);
  EXPECT_EQ(plannerFor(furnishedRoom(), coarse)->plan(request, cases).status,
            PlanStatus::kUnreachable);
  coarse.relax = true;
  const PlanResult found = plannerFor(furnishedRoom(), coarse)->plan(request, cases);
  EXPECT_EQ(found.status, PlanStatus::kSolved) << found.explanation;
}

TEST_F(DeadEndTest, plansWithoutAnotherWaySayWhereTheyMayEndInOne) {
  PlanRequest request = requestFor(Pose2(12.4, 7.5, 0.0), Pose2(14.2, 7.5, 0.0));
  const PlanResult safe = planner_->plan(request, pushes(1));
  ASSERT_EQ(safe.status, PlanStatus::kSolved) << safe.explanation;
  EXPECT_EQ(safe.dead_end, 0);

  request.tolerance.position_m = 0.04;  // Less than twice the outcome's standard deviation.
  const PlanResult risky = planner_->plan(request, pushes(1));
  ASSERT_EQ(risky.status, PlanStatus::kSolved) << risky.explanation;
  EXPECT_EQ(risky.plan.pushes.size(), 2U);
  EXPECT_GT(risky.dead_end, 0);
  EXPECT_NE(risky.explanation.find("may leave the object where no case can be applied"),
            std::string::npos)
      << risky.explanation;
}

}  // namespace
}  // namespace casepush
