#include <cmath>
#include <limits>

#include "execution/push_task_fixture.h"

namespace casepush {
namespace {

using test::FakePlans;
using test::FakeWorld;
using test::learntCases;
using test::searchPlan;

class PushTaskSafetyTest : public test::PushTaskTest {};

TEST_F(PushTaskSafetyTest, stopsInTheSameTickWhenThePlannerIsGone) {
  for (const char* phase : {"look", "planning", "approach", "dock", "push", "rest"}) {
    world = FakeWorld(1);
    plans = FakePlans();
    PushTask push_task = task();
    ASSERT_TRUE(runUntil(push_task, phase)) << phase;
    plans.alive = false;
    const Tick tick = push_task.tick(world.observe());
    EXPECT_TRUE(test::isZero(tick.command.twist));
    EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kPlannerGone);
    EXPECT_EQ(push_task.describe(), "the planner does not answer");
  }
}

TEST_F(PushTaskSafetyTest, cancelsInEveryPhase) {
  for (const char* phase : {"look", "planning", "approach", "dock", "push", "rest"}) {
    world = FakeWorld(1);
    plans = FakePlans();
    PushTask push_task = task();
    ASSERT_TRUE(runUntil(push_task, phase)) << phase;
    push_task.cancel();
    const Tick tick = push_task.tick(world.observe());
    EXPECT_TRUE(test::isZero(tick.command.twist));
    EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kCancelled);
    EXPECT_EQ(plans.cancels, std::string(phase) == "planning" ? 1 : 0);
  }
}

TEST_F(PushTaskSafetyTest, plansAnewWhereAPushWasStoppedBeforeTheObjectTouchedSomething) {
  bool is_there = false;
  services.touches = [&](const Observation&, const std::vector<Pose2>&) {
    return std::string(is_there ? "a visitor" : "");
  };
  PushTask push_task = task();
  ASSERT_TRUE(runUntil(push_task, "push"));
  is_there = true;
  ASSERT_TRUE(runUntil(push_task, "look"));
  EXPECT_EQ(push_task.describe(), "planning anew: stopped before chair_1 touched a visitor");
  EXPECT_EQ(push_task.progress().replan_causes, (ReplanCounts{{ReplanCause::kStoppedShort, 1}}));
  EXPECT_EQ(push_task.progress().pushes, 1);
  is_there = false;
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
      << push_task.describe();
}

TEST_F(PushTaskSafetyTest, isDoneWhereAPushWasStoppedAtTheGoal) {
  services.touches = [this](const Observation& observation, const std::vector<Pose2>&) {
    const Pose2& object = observation.objects.front().map_T_object;
    const bool is_near = distance(object, goal.map_T_goal) < 0.12 &&
                         std::abs(yawDifference(object, goal.map_T_goal)) < 0.2;
    return std::string(is_near ? "a wall" : "");
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
      << push_task.describe();
  EXPECT_EQ(reports.back().outcome, PushOutcome::kStoppedShort);
  EXPECT_EQ(push_task.progress().replan_causes.count(ReplanCause::kStoppedShort), 0u);
}

TEST_F(PushTaskSafetyTest, failsWhenTheObjectIsNotInSight) {
  world.object_visible = false;
  PushTask push_task = task();
  const double began_s = world.now_s;
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kObjectLost);
  EXPECT_EQ(push_task.describe(), "chair_1 is not in sight");
  EXPECT_NEAR(world.now_s - began_s, 10.0, 0.1);
}

TEST_F(PushTaskSafetyTest, looksAgainWhenTheObjectIsLostDuringAPush) {
  PushTask push_task = task();
  ASSERT_TRUE(runUntil(push_task, "push"));
  world.object_visible = false;
  ASSERT_TRUE(runUntil(push_task, "look"));
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].outcome, PushOutcome::kObjectLost);
  EXPECT_EQ(push_task.progress().pushes, 0);
  world.object_visible = true;
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kSucceeded)
      << push_task.describe();
}

TEST_F(PushTaskSafetyTest, findsAnObjectThatWasMovedOutOfSightAndGoesOn) {
  PushTask push_task = task();
  ASSERT_TRUE(runUntil(push_task, "push"));
  world.object = Pose2(-1.0, 1.4, 1.0);
  world.object_visible = false;
  bool searched = false;
  const auto hide = [&](const Observation&, const Tick&) {
    searched = searched || push_task.progress().phase == "search";
    world.object_visible = searched && (world.object_visible || world.robot.y() > 0.6);
  };
  EXPECT_EQ(test::run(push_task, world, 900.0, hide), BehaviourStatus::kSucceeded)
      << push_task.describe();
  EXPECT_EQ(push_task.status(), PushTaskStatus::kSucceeded);
  EXPECT_TRUE(searched);
}

TEST_F(PushTaskSafetyTest, givesUpAnObjectThatIsNowhereToBeSeen) {
  PushTask push_task = task();
  ASSERT_TRUE(runUntil(push_task, "push"));
  world.object_visible = false;
  const double lost_s = world.now_s;
  EXPECT_EQ(test::run(push_task, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kObjectLost);
  EXPECT_NE(push_task.describe().find("chair_1 is not in sight, looked for from"),
            std::string::npos)
      << push_task.describe();
  EXPECT_LT(world.now_s - lost_s, options.search.time_limit_s + 2.0);
}

TEST_F(PushTaskSafetyTest, stopsAndFailsWhenTheRobotIsLost) {
  for (const char* phase : {"look", "planning", "push"}) {
    world = FakeWorld(1);
    plans = FakePlans();
    PushTask push_task = task();
    ASSERT_TRUE(runUntil(push_task, phase)) << phase;
    world.robot_localised = false;
    plans.polls_left = 1000;
    const double lost_s = world.now_s;
    const BehaviourStatus status =
        test::run(push_task, world, 10.0, [&](const Observation& observation, const Tick& tick) {
          if (observation.stamp_s > lost_s + 0.21) {
            EXPECT_TRUE(test::isZero(tick.command.twist));
          }
        });
    EXPECT_EQ(status, BehaviourStatus::kFailed);
    EXPECT_EQ(push_task.status(), PushTaskStatus::kRobotLost) << phase;
  }
}

TEST_F(PushTaskSafetyTest, triesOtherPlansWhenTheRobotCanNotApproach) {
  services.approach = [](const Observation&, const Pose2&, double) {
    RobotPath none;
    none.explanation = "a desk is in the way";
    return none;
  };
  PushTask push_task = task();
  EXPECT_EQ(test::run(push_task, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push_task.status(), PushTaskStatus::kNoProgress);
  EXPECT_EQ(push_task.describe(), "the robot can not get to the next push: a desk is in the way");
  EXPECT_EQ(plans.requests.size(), 5u);
  EXPECT_NE(plans.requests[0].seed, plans.requests[1].seed);
}

TEST_F(PushTaskSafetyTest, givesUpAfterItsLimits) {
  world.object_fixed = true;
  options.max_replans = 3;
  options.max_idle_pushes = 100;
  PushTask few_plans = task();
  EXPECT_EQ(test::run(few_plans, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(few_plans.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(few_plans.describe().find("not at the goal after 3 new plans: still 2.2"),
            std::string::npos)
      << few_plans.describe();

  options = PushTaskOptions();
  options.max_pushes = 2;
  PushTask few_pushes = task();
  EXPECT_EQ(test::run(few_pushes, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(few_pushes.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(few_pushes.describe().find("after 2 pushes"), std::string::npos);

  options = PushTaskOptions();
  options.max_idle_pushes = 3;
  PushTask no_motion = task();
  EXPECT_EQ(test::run(no_motion, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(no_motion.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(no_motion.describe().find("chair_1 did not move in 3 pushes in a row: still 2.2"),
            std::string::npos)
      << no_motion.describe();

  options = PushTaskOptions();
  options.max_plans_without_progress = 4;
  options.max_idle_pushes = 100;
  PushTask no_progress = task();
  EXPECT_EQ(test::run(no_progress, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(no_progress.status(), PushTaskStatus::kNoProgress);
  EXPECT_NE(no_progress.describe().find("4 plans in a row brought chair_1 no nearer"),
            std::string::npos)
      << no_progress.describe();

  goal.time_limit_s = 5.0;
  options = PushTaskOptions();
  PushTask short_time = task();
  EXPECT_EQ(test::run(short_time, world, 900.0), BehaviourStatus::kFailed);
  EXPECT_EQ(short_time.status(), PushTaskStatus::kTimeout);
}

}  // namespace
}  // namespace casepush
