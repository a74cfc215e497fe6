#include "casepush/execution/push_task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "casepush/common/input_error.h"
#include "execution/push_task_fixture.h"

namespace casepush {
namespace {

using test::FakePlans;
using test::fakeRobot;
using test::FakeWorld;
using test::learntCases;
using test::PushTaskTest;
using test::searchPlan;

TEST_F(PushTaskTest, bringsTheObjectToTheGoalByGroundTruth) {
  for (int seed = 1; seed <= 8; ++seed) {
    world = FakeWorld(seed);
    world.scatter = 0.08;
    world.noise_m = 0.005;
    goal.seed = seed;
    reports.clear();
    plan_reports = 0;
    PushTask push_task = task();
    ASSERT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
        << "seed " << seed << ": " << push_task.describe();
    EXPECT_EQ(push_task.status(), PushTaskStatus::kSucceeded);
    EXPECT_TRUE(goal.tolerance.isMet(goal.map_T_goal, world.object)) << "seed " << seed;
    const PushTaskProgress& progress = push_task.progress();
    EXPECT_EQ(progress.pushes, static_cast<int>(reports.size()));
    EXPECT_EQ(progress.plans, plan_reports);
    EXPECT_EQ(static_cast<int>(progress.pushes_per_plan.size()), progress.replans + 1);
    EXPECT_EQ(static_cast<int>(progress.pushes_unchanged.size()),
              progress.replans + progress.repairs + 1);
    EXPECT_GE(progress.plans, progress.replans + progress.repairs + 1);
    EXPECT_GT(progress.plan_length_m, 1.5);
    EXPECT_LT(progress.distance_to_goal_m, 0.2);
    EXPECT_EQ(progress.phase, "done");
    EXPECT_TRUE(test::isZero(push_task.tick(world.observe()).command.twist));
  }
}

TEST_F(PushTaskTest, doesNothingIfTheObjectIsAtTheGoalAlready) {
  goal.map_T_goal = Pose2(0.05, 0.0, 0.1);
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kSucceeded);
  EXPECT_TRUE(plans.requests.empty());
  EXPECT_LT(distance(world.robot, Pose2(-1.5, 0.0, 0.0)), 1e-9);
}

TEST_F(PushTaskTest, aimsForTheInnerPartOfTheToleranceButAcceptsItsEdge) {
  goal.map_T_goal = Pose2(0.193, 0.0, 0.0);  // Within 0.2 m, but not for sure.
  world.noise_m = 0.0;
  plans.answer = [](const PlanRequest&) {
    PlanResult none;
    none.status = PlanStatus::kUnreachable;
    return none;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kSucceeded);
  ASSERT_EQ(plans.requests.size(), 1u);
  EXPECT_NEAR(plans.requests[0].tolerance.position_m, 0.18, 1e-12);
  EXPECT_EQ(push_task.describe(), "chair_1 is at the goal, within the tolerance");
}

TEST_F(PushTaskTest, plansAnewWhenThePredictionIsRejected) {
  options.rest.replan_when_rejected = true;
  world.scatter = 0.0;
  world.deceleration_mps2 = 0.08;  // It rolls on much farther than the cases say.
  PushTask push_task = task();
  for (int i = 0; i < 30000 && push_task.progress().replans == 0; ++i) {
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(push_task.progress().replans, 1);
  EXPECT_GE(push_task.progress().rejected_predictions, 1);
  EXPECT_EQ(push_task.describe(), "planning anew: chair_1 rests elsewhere than predicted");
}

TEST_F(PushTaskTest, plansAnewWhenTheRestIsNotValidAnyMore) {
  services.continue_plan = [](const PushPlan& rest, const Pose2&, const std::vector<Case>&,
                              const std::vector<PlacedObject>&) {
    PushPlanner::Continuation blocked;
    blocked.plan = rest;
    blocked.explanation = "push 1: the chair would hit a wall";
    blocked.chained = true;
    return blocked;
  };
  world.scatter = 0.0;
  PushTask push_task = task();
  for (int i = 0; i < 30000 && push_task.progress().replans == 0; ++i) {
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(reports.size(), 1u);
  EXPECT_EQ(push_task.describe(), "planning anew: push 1: the chair would hit a wall");
  EXPECT_EQ(push_task.progress().replan_causes, (ReplanCounts{{ReplanCause::kRestCollides, 1}}));
  EXPECT_EQ(push_task.progress().pushes_per_plan, std::vector<int>{1});
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded);
}

TEST_F(PushTaskTest, plansAnewBeforeAPushThatMayEndInADeadEnd) {
  services.continue_plan = [this](const PushPlan& rest, const Pose2& pose, const std::vector<Case>&,
                                  const std::vector<PlacedObject>&) {
    PushPlanner::Continuation continuation = test::reanchored(rest, pose);
    continuation.may_get_stuck = plans.requests.size() == 1;
    return continuation;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded);
  EXPECT_EQ(push_task.progress().pushes_per_plan.front(), 1);
  EXPECT_EQ(push_task.progress().replan_history.front(), ReplanCause::kDeadEndAhead);
}

TEST_F(PushTaskTest, makesAPushIntoADeadEndOfWhichThePlannerKnewNoWayAround) {
  goal.map_T_goal = Pose2(4.0, 1.0, 0.5);
  world.scatter = 0.0;
  plans.answer = [](const PlanRequest& request) {
    PlanResult result = test::searchPlan(request);
    result.dead_end = 3;
    return result;
  };
  std::vector<int> asked;  // Before which pushes.
  services.continue_plan = [&](const PushPlan& rest, const Pose2& pose, const std::vector<Case>&,
                               const std::vector<PlacedObject>&) {
    PushPlanner::Continuation continuation = test::reanchored(rest, pose);
    asked.push_back(static_cast<int>(reports.size()) + 1);
    continuation.may_get_stuck = asked.back() == 3 || asked.back() == 4;
    return continuation;
  };
  PushTask push_task = task();
  for (int i = 0; i < 40000 && push_task.progress().replans == 0; ++i) {
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(asked, (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(push_task.progress().pushes_per_plan, std::vector<int>{3});
  EXPECT_EQ(push_task.progress().replan_causes, (ReplanCounts{{ReplanCause::kDeadEndAhead, 1}}));
}

TEST_F(PushTaskTest, failsAtOnceWithThePlannersWordsIfTheGoalIsInvalid) {
  for (const PlanStatus status : {PlanStatus::kInvalidRequest, PlanStatus::kNoCases,
                                  PlanStatus::kGoalInCollision, PlanStatus::kGoalOutsideMap}) {
    plans = FakePlans();
    plans.answer = [status](const PlanRequest&) {
      PlanResult result;
      result.status = status;
      result.explanation = "the goal is in a wall";
      return result;
    };
    PushTask push_task = task();
    EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kInvalidGoal);
    EXPECT_EQ(push_task.describe(), "the goal is in a wall");
    EXPECT_EQ(plans.requests.size(), 1u);
  }
}

TEST_F(PushTaskTest, refusesAGoalThatIsNotFinite) {
  goal.map_T_goal = Pose2(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  PushTask push_task = task();
  EXPECT_EQ(push_task.tick(world.observe()).status, BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kInvalidGoal);
  EXPECT_TRUE(plans.requests.empty());
}

TEST_F(PushTaskTest, triesFailedPlansWithOtherSeeds) {
  plans.answer = [](const PlanRequest&) {
    PlanResult result;
    result.status = PlanStatus::kDeadline;
    result.explanation = "no plan within 10 s";
    return result;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kNoPlan);
  EXPECT_EQ(push_task.describe(), "no plan after 5 attempts: no plan within 10 s");
  std::set<std::uint64_t> seeds;
  for (const PlanRequest& request : plans.requests) {
    seeds.insert(request.seed);
  }
  EXPECT_EQ(seeds.size(), 5u);
}

TEST_F(PushTaskTest, aPlanWithAnUnknownCaseIsAFailedPlan) {
  plans.answer = [](const PlanRequest& request) {
    PlanResult result = searchPlan(request);
    result.plan.pushes.front().case_id = 999;
    return result;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kNoPlan);
  EXPECT_NE(push_task.describe().find("case 999"), std::string::npos);
}

TEST_F(PushTaskTest, isDeterministic) {
  std::vector<PushReport> first;
  for (int round = 0; round < 2; ++round) {
    world = FakeWorld(3);
    world.scatter = 0.08;
    plans = FakePlans();
    reports.clear();
    PushTask push_task = task();
    test::run(push_task, world, 900.0);
    if (round == 0) {
      first = reports;
    }
  }
  ASSERT_EQ(reports.size(), first.size());
  EXPECT_DOUBLE_EQ(reports.back().map_T_end.x(), first.back().map_T_end.x());
  EXPECT_DOUBLE_EQ(reports.back().end_stamp_s, first.back().end_stamp_s);
}

TEST_F(PushTaskTest, refusesMissingServicesAndBadOptions) {
  services.continue_plan = nullptr;
  EXPECT_THROW(task(), InputError);
  services.plans = nullptr;
  EXPECT_THROW(task(), InputError);
  options.max_pushes = 0;
  try {
    task();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "push task options: max_pushes is 0, must be in [1, 100000]");
  }
}

}  // namespace
}  // namespace casepush
