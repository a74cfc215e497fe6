#include <gtest/gtest.h>

#include "casepush/common/input_error.h"
#include "planning/planner_fixture.h"

namespace casepush {
namespace {

PushPlannerOptions chance(double most, PlannerKind kind = PlannerKind::kLattice) {
  PushPlannerOptions options = PushPlannerOptions::forPlanner(kind);
  options.max_nodes = 15000;
  options.risk.model = RiskModel::kChance;
  options.risk.max_collision_probability = most;
  return options;
}

/// A wall with one gap of `width_m` between start and goal.
WorldModel roomWithGap(double width_m) {
  WorldModel world = emptyRoom();
  const double length_m = 7.4 - 0.5 * width_m;
  world.boxes.push_back(standing("wall_south", 7.5, 0.1 + 0.5 * length_m, 0.1, length_m, 1.5));
  world.boxes.push_back(standing("wall_north", 7.5, 14.9 - 0.5 * length_m, 0.1, length_m, 1.5));
  return world;
}

const Pose2 kBeforeGap(5.0, 7.5, 0.0);
const Pose2 kBehindGap(10.0, 7.5, 0.0);

TEST(ChanceConstraint, keepsTheProbabilityOfTheWholePlan) {
  const auto planner = plannerFor(furnishedRoom(), chance(0.05));
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanResult result = planner->plan(requestFor(kStart, kGoal), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_EQ(result.plan.max_collision_probability, 0.05);
  EXPECT_LE(result.plan.collision_probability, 0.05 + 1e-9);
  double free = 1.0;
  for (const PlannedPush& push : result.plan.pushes) free *= 1.0 - push.collision_probability;
  EXPECT_NEAR(result.plan.collision_probability, 1.0 - free, 1e-9);
  EXPECT_GT(result.expected_s, 0.0);
  EXPECT_GE(result.bound, 1.0);
}

TEST(ChanceConstraint, tellsWhenNoPlanKeepsIt) {
  // 12 cm on each side of the chair, with 8 cm of standard deviation.
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.08;
  PushPlannerOptions options = chance(0.01);
  options.max_nodes = 1500;
  const auto planner = plannerFor(roomWithGap(0.85), options);
  const std::vector<Case> cases = syntheticPushes(14, 7, imprecise);
  const PlanResult result = planner->plan(requestFor(kBeforeGap, kBehindGap), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_GT(*result.plan.max_collision_probability, 0.01);
  EXPECT_LE(result.plan.collision_probability, *result.plan.max_collision_probability + 1e-9);
  EXPECT_NE(result.explanation.find("no plan keeps 0.010"), std::string::npos)
      << result.explanation;
}

TEST(ChanceConstraint, leavesTimeForLargerProbabilities) {
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.08;
  PushPlannerOptions options = chance(1e-5);
  options.max_nodes = 10000000;
  PlanRequest request = requestFor(kBeforeGap, kBehindGap);
  request.deadline_s = 2.0;
  const PlanResult result =
      plannerFor(roomWithGap(0.85), options)->plan(request, syntheticPushes(14, 7, imprecise));
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_LT(result.planning_s, 4.0) << "a busy machine included";
}

TEST(ChanceConstraint, prefersPreciseCasesOfEqualLength) {
  // The same pushes twice, once precise and once not; nothing but the scatter tells them apart.
  SyntheticPushOptions precise;
  precise.position_sigma_m = 0.01;
  precise.yaw_sigma_rad = 0.01;
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.06;
  std::vector<Case> cases = syntheticPushes(8, 7, imprecise);
  for (Case& push_case : syntheticPushes(8, 7, precise)) {
    push_case.id += 100;
    cases.push_back(push_case);
  }
  const PlanResult result =
      plannerFor(emptyRoom(), chance(0.05))->plan(requestFor(kBeforeGap, kBehindGap), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  for (const PlannedPush& push : result.plan.pushes) EXPECT_GT(push.case_id, 100);
}

TEST(ChanceConstraint, givesARestUpOnlyIfItIsMuchRiskier) {
  const auto planner = plannerFor(roomWithGap(1.6), chance(0.02));
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanResult result = planner->plan(requestFor(kBeforeGap, kBehindGap), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  PushPlan rest = result.plan;
  rest.tolerance = {5.0, 3.0};
  EXPECT_TRUE(planner->continuePlan(rest, kBeforeGap, cases, {}).valid);
  bool riskier = false;
  bool impossible = false;
  for (double aside_m = 0.0; aside_m < 1.0; aside_m += 0.02) {
    const auto moved = planner->continuePlan(rest, kBeforeGap * Pose2(0, aside_m, 0), cases, {});
    EXPECT_EQ(moved.valid, moved.explanation.empty());
    if (moved.valid) {
      EXPECT_LE(moved.plan.collision_probability, 0.04);
    } else if (moved.explanation.find("with probability") != std::string::npos) {
      EXPECT_GT(moved.plan.collision_probability, 0.04);
      riskier = true;
    } else {
      impossible = true;
    }
  }
  EXPECT_TRUE(riskier);
  EXPECT_TRUE(impossible);
}

TEST(ChanceConstraint, isRefusedWhereItIsNotKnown) {
  try {
    plannerFor(emptyRoom(), chance(0.05, PlannerKind::kOmplRrt));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("ompl_rrt knows no chance constraints"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace casepush
