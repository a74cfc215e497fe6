#include <gtest/gtest.h>

#include "execution/push_task_fixture.h"

namespace casepush {
namespace {

/// A task whose first plan misses the goal from its second push on, wherever the object comes to
/// rest: continue_plan turns the rest aside until a new plan is there.
class PushTaskRepairTest : public test::PushTaskTest {
 protected:
  PushTaskRepairTest() {
    world.scatter = 0.0;
    goal.map_T_goal = Pose2(4.0, 1.0, 0.5);
    services.continue_plan = [this](const PushPlan& rest, const Pose2& pose,
                                    const std::vector<Case>&, const std::vector<PlacedObject>&) {
      PushPlanner::Continuation continuation = test::reanchored(rest, pose);
      if (misses_always || plans.requests.size() == 1) {
        continuation.plan.map_T_goal = rest.map_T_goal * Pose2(3.0, 3.0, 0.0);
        continuation.valid = false;
        continuation.explanation = "it ends far from the goal";
      }
      return continuation;
    };
  }

  bool misses_always = false;

  void runUntilPushes(PushTask& push_task, int count) {
    for (int i = 0; i < 40000 && push_task.progress().pushes < count &&
                    push_task.status() == PushTaskStatus::kRunning;
         ++i) {
      world.advance(push_task.tick(world.observe()).command.twist);
    }
    ASSERT_EQ(push_task.progress().pushes, count) << push_task.describe();
  }
};

TEST_F(PushTaskRepairTest, plansWhatFollowsWhileTheNextPushIsMade) {
  PushTask push_task = task();
  runUntilPushes(push_task, 1);
  const PushPlan before = *push_task.plan();
  ASSERT_GE(before.pushes.size(), 2u);
  ASSERT_EQ(plans.requests.size(), 2u);
  // From where the push that is being made should end, with the robot at its side.
  const PlanRequest& tail = plans.requests.back();
  const PlannedPush& next = before.pushes.front();
  EXPECT_NEAR(distance(tail.object.map_T_object, next.map_outcome.mean), 0.0, 1e-9);
  EXPECT_LT(distance(tail.map_T_robot, tail.object.map_T_object), 1.0);
  EXPECT_NE(tail.seed, plans.requests.front().seed);
  EXPECT_EQ(push_task.progress().phase, "approach");
  EXPECT_EQ(push_task.progress().replans, 0);

  plans.polls_left = 0;  // Long before the push is over.
  runUntilPushes(push_task, 2);
  EXPECT_EQ(reports.back().case_id, next.case_id);
  EXPECT_EQ(push_task.progress().repairs, 1);
  EXPECT_EQ(push_task.progress().replans, 0);
  EXPECT_EQ(push_task.progress().pushes_per_plan, std::vector<int>{2});
  EXPECT_EQ(push_task.progress().pushes_unchanged, (std::vector<int>{2, 0}));
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
      << push_task.describe();
}

TEST_F(PushTaskRepairTest, plansAnewIfNothingWasFoundMeanwhile) {
  misses_always = true;
  plans.answer = [this](const PlanRequest& request) {
    return plans.requests.size() > 1 ? PlanResult() : test::searchPlan(request);
  };
  PushTask push_task = task();
  runUntilPushes(push_task, 1);
  for (int i = 0; i < 40000 && push_task.progress().replans == 0; ++i) {
    plans.polls_left = 0;
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(push_task.progress().pushes, 2);
  EXPECT_EQ(push_task.progress().repairs, 0);
  EXPECT_EQ(push_task.progress().replan_causes, (ReplanCounts{{ReplanCause::kRestMissesGoal, 1}}));
}

TEST_F(PushTaskRepairTest, aPlannerThatIsTooSlowIsStopped) {
  PushTask push_task = task();
  runUntilPushes(push_task, 1);
  plans.polls_left = 1000000;
  runUntilPushes(push_task, 2);
  EXPECT_EQ(plans.cancels, 1);
  EXPECT_EQ(push_task.progress().repairs, 0);
}

TEST_F(PushTaskRepairTest, endsWithTheTask) {
  PushTask push_task = task();
  runUntilPushes(push_task, 1);
  push_task.cancel();
  world.advance(push_task.tick(world.observe()).command.twist);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kCancelled);
  EXPECT_EQ(plans.cancels, 1);
}

TEST_F(PushTaskRepairTest, canBeSwitchedOff) {
  options.rest.repair = false;
  PushTask push_task = task();
  for (int i = 0; i < 40000 && push_task.progress().replans == 0; ++i) {
    world.advance(push_task.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(push_task.progress().pushes, 1);
  EXPECT_EQ(push_task.progress().replans, 1);
}

}  // namespace
}  // namespace casepush
