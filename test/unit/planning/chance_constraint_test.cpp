#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "casepush/common/input_error.h"
#include "planning/planner_fixture.h"

namespace casepush {
namespace {

PushPlannerOptions chance(double most, PlannerKind kind) {
  PushPlannerOptions options = PushPlannerOptions::forPlanner(kind);
  options.max_nodes = 15000;
  options.improvement_extensions = 2000;
  options.risk.model = RiskModel::kChance;
  options.risk.max_collision_probability = most;
  return options;
}

/// Walls with one gap of `width_m` each between start and goal.
WorldModel roomWithGaps(double width_m, const std::vector<double>& walls_x_m) {
  WorldModel world = emptyRoom();
  const double length_m = 7.4 - 0.5 * width_m;
  for (const double x_m : walls_x_m) {
    const std::string name = "wall_" + std::to_string(world.boxes.size());
    world.boxes.push_back(standing(name + "_south", x_m, 0.1 + 0.5 * length_m, 0.1, length_m, 1.5));
    world.boxes.push_back(
        standing(name + "_north", x_m, 14.9 - 0.5 * length_m, 0.1, length_m, 1.5));
  }
  return world;
}

WorldModel roomWithGap(double width_m) { return roomWithGaps(width_m, {7.5}); }

const Pose2 kBeforeGap(5.0, 7.5, 0.0);
const Pose2 kBehindGap(10.0, 7.5, 0.0);

/// Of every planner that knows it.
class ChanceConstraint : public testing::TestWithParam<PlannerKind> {};

TEST_P(ChanceConstraint, keepsTheProbabilityOfTheWholePlan) {
  const auto planner = plannerFor(furnishedRoom(), chance(0.05, GetParam()));
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanResult result = planner->plan(requestFor(kStart, kGoal), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_EQ(result.plan.max_collision_probability, 0.05);
  EXPECT_LE(result.plan.collision_probability, 0.05 + 1e-9);
  double free = 1.0;
  for (const PlannedPush& push : result.plan.pushes) free *= 1.0 - push.collision_probability;
  EXPECT_NEAR(result.plan.collision_probability, 1.0 - free, 1e-9);
  EXPECT_EQ(result.plan.zeta, 0.0);
  EXPECT_GT(result.expected_s, 0.0);
  EXPECT_EQ(result.bound >= 1.0, GetParam() == PlannerKind::kLattice);
}

TEST_P(ChanceConstraint, addsUpWhatEachPushRisks) {
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.06;
  const std::vector<Case> cases = syntheticPushes(14, 7, imprecise);
  const WorldModel world = roomWithGaps(1.1, {6.2, 7.5, 8.8});
  PushPlannerOptions options = chance(1.0, GetParam());
  options.risk.recovery_s = 0.0;
  const PlanRequest request = requestFor(kBeforeGap, kBehindGap);
  const PlanResult bold = plannerFor(world, options)->plan(request, cases);
  ASSERT_EQ(bold.status, PlanStatus::kSolved) << bold.explanation;
  double largest = 0.0;
  for (const PlannedPush& push : bold.plan.pushes) {
    largest = std::max(largest, push.collision_probability);
  }
  ASSERT_LT(largest, 1.0) << "a mean motion collides";
  // Each push keeps this limit, and all together do not.
  options.risk.max_collision_probability = 1.01 * largest;
  ASSERT_GT(bold.plan.collision_probability, 1.2 * options.risk.max_collision_probability);
  const PlanResult result = plannerFor(world, options)->plan(request, cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_LE(result.plan.collision_probability, *result.plan.max_collision_probability + 1e-9);
  EXPECT_LT(result.plan.collision_probability, bold.plan.collision_probability);
}

TEST_P(ChanceConstraint, tellsWhenNoPlanKeepsIt) {
  // 12 cm on each side of the chair, with 8 cm of standard deviation.
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.08;
  PushPlannerOptions options = chance(0.01, GetParam());
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

TEST_P(ChanceConstraint, leavesTimeForLargerProbabilities) {
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.05;
  PushPlannerOptions options = chance(1e-5, GetParam());
  options.max_nodes = 10000000;
  options.risk.recovery_s = 0.0;
  PlanRequest request = requestFor(kBeforeGap, kBehindGap);
  request.deadline_s = 4.0;
  const PlanResult result =
      plannerFor(roomWithGap(0.85), options)->plan(request, syntheticPushes(14, 7, imprecise));
  EXPECT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  EXPECT_LT(result.planning_s, 8.0) << "a busy machine included";
}

TEST_P(ChanceConstraint, prefersPreciseCasesOfEqualLength) {
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
  const PlanResult result = plannerFor(emptyRoom(), chance(0.05, GetParam()))
                                ->plan(requestFor(kBeforeGap, kBehindGap), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  for (const PlannedPush& push : result.plan.pushes) EXPECT_GT(push.case_id, 100);
}

TEST_P(ChanceConstraint, givesARestUpOnlyIfItIsMuchRiskier) {
  const auto planner = plannerFor(roomWithGap(1.6), chance(0.02, GetParam()));
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

TEST_P(ChanceConstraint, goesOnUpToWhereTheRestGetsRisky) {
  const auto planner = plannerFor(emptyRoom(), chance(0.02, GetParam()));
  const std::vector<Case> cases = syntheticPushes(14, 7);
  const PlanResult result = planner->plan(requestFor(kBeforeGap, kBehindGap), cases);
  ASSERT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
  ASSERT_GE(result.plan.pushes.size(), 4U);
  // Another chair comes nearer and nearer to where the last push ends.
  const Pose2 end = result.plan.pushes.back().map_outcome.mean;
  const int count = static_cast<int>(result.plan.pushes.size());
  bool is_risky = false;
  for (double beside_m = 1.2; beside_m > 0.5 && !is_risky; beside_m -= 0.02) {
    const auto rest = planner->continuePlan(
        result.plan, kBeforeGap, cases,
        {{"other", "chair", end * Pose2(0.5 * beside_m, 0.87 * beside_m, 0)}});
    is_risky = rest.explanation.find("with probability") != std::string::npos;
    EXPECT_TRUE(rest.valid != is_risky) << rest.explanation;
    EXPECT_GE(rest.applicable, count - 2) << rest.explanation;
    EXPECT_EQ(rest.applicable < count, is_risky) << rest.explanation;
  }
  EXPECT_TRUE(is_risky);
}

TEST_P(ChanceConstraint, keepsAwayFromWhatDeviationsWouldRunInto) {
  // Through a gap with 15 cm on each side of the chair, or around its walls: where the limit is no
  // matter, the gap is quicker, but after some pushes the object hardly ever stands before it.
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("south", 7.5, 7.5 - 1.45, 0.1, 2.0, 1.5));
  world.boxes.push_back(standing("north", 7.5, 7.5 + 1.45, 0.1, 2.0, 1.5));
  const std::vector<Case> cases = syntheticPushes(14, 7);
  PlanRequest request = requestFor(Pose2(3.5, 7.5, 0.0), Pose2(11.0, 7.5, 0.0));
  request.tolerance = {0.5, 1.0};  // Missing the goal is no matter.
  const auto goesThrough = [&](double recovery_s) {
    PushPlannerOptions options = chance(1.0, GetParam());
    options.risk.recovery_s = recovery_s;
    const PlanResult result = plannerFor(world, options)->plan(request, cases);
    EXPECT_EQ(result.status, PlanStatus::kSolved) << result.explanation;
    return std::all_of(result.plan.pushes.begin(), result.plan.pushes.end(), [](const auto& push) {
      const Pose2& end = push.map_outcome.mean;
      return std::abs(end.x() - 7.5) > 1.0 || std::abs(end.y() - 7.5) < 1.0;
    });
  };
  EXPECT_TRUE(goesThrough(0.0));
  EXPECT_FALSE(goesThrough(200.0));
}

TEST_P(ChanceConstraint, countsRecoveriesAsTime) {
  // With nothing to hit, the same chain costs more only by what its scatter will cost.
  SyntheticPushOptions imprecise;
  imprecise.position_sigma_m = 0.06;
  const std::vector<Case> cases = syntheticPushes(8, 7, imprecise);
  PushPlannerOptions options = chance(0.05, GetParam());
  options.risk.recovery_s = 0.0;
  const PlanRequest request = requestFor(kBeforeGap, kBehindGap);
  const PlanResult free = plannerFor(emptyRoom(), options)->plan(request, cases);
  options.risk.recovery_s = 100.0;
  const PlanResult dear = plannerFor(emptyRoom(), options)->plan(request, cases);
  ASSERT_EQ(free.status, PlanStatus::kSolved) << free.explanation;
  ASSERT_EQ(dear.status, PlanStatus::kSolved) << dear.explanation;
  // Drift alone: trace / (0.2 m)^2 of each push.
  const double least_s = 100.0 * dear.plan.pushes.size() * 2.0 * 0.06 * 0.06 / (0.2 * 0.2);
  EXPECT_GT(dear.expected_s, least_s);
  EXPECT_LT(free.expected_s, dear.expected_s);
}

INSTANTIATE_TEST_SUITE_P(Planners, ChanceConstraint,
                         testing::Values(PlannerKind::kLattice, PlannerKind::kExpRrt),
                         [](const auto& planner) { return toString(planner.param); });

TEST(ChanceConstraintOfOthers, isRefused) {
  PushPlannerOptions as_printed = chance(0.05, PlannerKind::kExpRrt);
  as_printed.similarity = Similarity::kPaper;
  for (const PushPlannerOptions& options :
       {chance(0.05, PlannerKind::kOmplRrt), chance(0.05, PlannerKind::kExpRrtPaper), as_printed}) {
    try {
      plannerFor(emptyRoom(), options);
      FAIL() << toString(options.planner);
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("knows no chance constraints; use lattice or exp_rrt"), std::string::npos)
          << text;
    }
  }
}

}  // namespace
}  // namespace casepush
