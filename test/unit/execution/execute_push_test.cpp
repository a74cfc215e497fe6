#include "casepush/execution/execute_push.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/common/input_error.h"
#include "execution/pushes.h"

namespace casepush {
namespace {

using test::fakeRobot;
using test::FakeWorld;
using test::firstTrial;
using test::replay;
using Phase = ExecutePush::Phase;

// A case that was tried `count` times in worlds with a little scatter.
Case learntCase(int count, PushConfiguration configuration = test::straightPush()) {
  Case learnt;
  for (int i = 0; i < count; ++i) {
    FakeWorld world(100 + i);
    world.scatter = 0.05;
    world.object = Pose2(0.3 * i, -0.2 * i, 0.5 * i);
    ExecutePush push = i == 0 ? firstTrial(configuration) : replay(learnt);
    EXPECT_EQ(test::run(push, world), BehaviourStatus::kSucceeded) << push.describe();
    if (i == 0) {
      learnt = push.report()->recorded;
      learnt.id = 7;
      continue;
    }
    const OutcomeStatistics now =
        addObservation({learnt.start_outcome, learnt.effective_count},
                       push.report()->recorded.start_outcome.mean, CovarianceFloor{});
    learnt.start_outcome = now.start_outcome;
    learnt.effective_count = now.effective_count;
  }
  return learnt;
}

TEST(ExecutePush, recordsAFirstTrialAsACase) {
  FakeWorld world(1);
  world.object = Pose2(0.5, 1.0, 0.7);
  const Pose2 before = world.object;
  ExecutePush push = firstTrial();
  ASSERT_EQ(test::run(push, world), BehaviourStatus::kSucceeded) << push.describe();
  const PushReport& report = *push.report();
  EXPECT_EQ(report.outcome, PushOutcome::kDone);
  EXPECT_EQ(report.case_id, 0);
  EXPECT_LT(distance(report.map_T_start, before), 0.01);
  EXPECT_LT(distance(report.map_T_end, world.object), 0.01);

  const Case& recorded = report.recorded;
  EXPECT_NO_THROW(validateCase(recorded, "recorded"));
  EXPECT_EQ(recorded.object, "disc");
  EXPECT_EQ(recorded.robot, "disc_robot");
  EXPECT_EQ(recorded.push_steps, 21);     // 2 s at 0.1 s, both ends included.
  EXPECT_GT(recorded.steps.size(), 22u);  // It coasted.
  EXPECT_EQ(recorded.observation_count, 1);
  EXPECT_DOUBLE_EQ(recorded.effective_count, 1.0);
  const CaseStep& first = recorded.steps.front();
  EXPECT_LT(first.start_T_object.position().norm(), 1e-9);
  EXPECT_LT(distance(first.object_T_robot, test::straightPush().object_T_robot), 0.02);
  const Pose2 outcome = report.map_T_start.inverse() * report.map_T_end;
  EXPECT_NEAR(distance(recorded.steps.back().start_T_object, outcome), 0.0, 1e-9);
  EXPECT_NEAR(distance(recorded.start_outcome.mean, outcome), 0.0, 1e-9);
  EXPECT_GT(outcome.x(), 0.4);
  EXPECT_TRUE(test::isZero(recorded.steps.back().action));
  EXPECT_TRUE(isObservation(report));
}

TEST(ExecutePush, replayRepeatsThePushWhereverTheObjectStands) {
  PushConfiguration turning = test::straightPush();
  turning.yaw_rate_rps = 0.3;
  FakeWorld world(1);
  ExecutePush first = firstTrial(turning);
  ASSERT_EQ(test::run(first, world), BehaviourStatus::kSucceeded);
  Case push_case = first.report()->recorded;
  push_case.id = 3;
  for (int seed = 2; seed < 8; ++seed) {
    FakeWorld other(seed);
    other.object = Pose2(1.0, -2.0, 0.9 * seed);
    ExecutePush again = replay(push_case);
    ASSERT_EQ(test::run(again, other), BehaviourStatus::kSucceeded) << again.describe();
    const PushReport& report = *again.report();
    EXPECT_EQ(report.case_id, 3);
    EXPECT_EQ(report.recorded.push_steps, push_case.push_steps);
    const Pose2 outcome = report.recorded.start_outcome.mean;
    EXPECT_LT(distance(outcome, push_case.start_outcome.mean), 0.06);
    EXPECT_LT(std::abs(yawDifference(outcome, push_case.start_outcome.mean)), 0.2);
  }
}

TEST(ExecutePush, staysWithinTheRobotsLimitsAllTheTime) {
  FakeWorld world(2);
  world.object = Pose2(0.0, 2.0, -1.0);
  ExecutePush push = firstTrial();
  const RobotLimits limits = fakeRobot().limits;
  Twist2 last;
  double fastest = 0.0;
  test::run(push, world, 120.0, [&](const Observation&, const Tick& tick) {
    const Twist2& now = tick.command.twist;
    EXPECT_LE(now.speed(), limits.max_speed_mps + 1e-9);
    EXPECT_LE(std::abs(now.wz_rps), limits.max_yaw_rate_rps + 1e-9);
    if (!test::isZero(now)) {  // It may stop at once.
      const Twist2 steady = rotate(last, -last.wz_rps * FakeWorld::kTickS);
      EXPECT_LE(std::hypot(now.vx_mps - steady.vx_mps, now.vy_mps - steady.vy_mps),
                limits.max_acceleration_mps2 * FakeWorld::kTickS + 1e-9);
      EXPECT_LE(std::abs(now.wz_rps - last.wz_rps),
                limits.max_yaw_acceleration_rps2 * FakeWorld::kTickS + 1e-9);
    }
    fastest = std::max(fastest, now.speed());
    last = now;
  });
  EXPECT_GT(fastest, 0.45);
}

TEST(ExecutePush, goesThroughItsPhasesAndStandsStillWhileTheObjectCoasts) {
  FakeWorld world(3);
  ExecutePush push = firstTrial();
  std::vector<Phase> phases;
  double rest_began_s = 0.0;
  test::run(push, world, 120.0, [&](const Observation& observation, const Tick& tick) {
    if (phases.empty() || phases.back() != push.phase()) phases.push_back(push.phase());
    if (push.phase() == Phase::kDock) {
      EXPECT_FALSE(world.touching());
    }
    if (push.phase() == Phase::kRest) {
      rest_began_s = rest_began_s > 0.0 ? rest_began_s : observation.stamp_s;
      EXPECT_TRUE(test::isZero(tick.command.twist));
    }
  });
  EXPECT_EQ(phases, (std::vector<Phase>{Phase::kApproach, Phase::kDock, Phase::kPush, Phase::kRest,
                                        Phase::kFinished}));
  EXPECT_GT(push.report()->end_stamp_s, rest_began_s + 0.4);
  EXPECT_LT(push.report()->end_stamp_s, rest_began_s + 2.0);
  for (int i = 0; i < 5; ++i) {
    const Tick tick = push.tick(world.observe());
    EXPECT_TRUE(test::isZero(tick.command.twist));
    EXPECT_EQ(tick.status, BehaviourStatus::kSucceeded);
  }
}

TEST(ExecutePush, doesNotWaitAtTheStartForWhatItSawAtRestOnTheWay) {
  FakeWorld world(3);
  ExecutePushOptions options;
  options.rest_time_s = 1.5;
  ExecutePush push("chair_1", test::straightPush(), fakeRobot(), test::detour, options);
  int settling = 0;
  test::run(push, world, 120.0, [&](const Observation&, const Tick&) {
    settling += push.describe() == "settling beside chair_1" ? 1 : 0;
  });
  EXPECT_EQ(push.report()->outcome, PushOutcome::kDone);
  EXPECT_GT(settling, 0);
  EXPECT_LT(settling * FakeWorld::kTickS, 0.75);
}

TEST(ExecutePush, tellsWhyThereIsNoApproach) {
  FakeWorld world(8);
  ExecutePush push = firstTrial(test::straightPush(), [](const Observation&, const Pose2&, double) {
    RobotPath none;
    none.explanation = "the start of the push is in a wall";
    return none;
  });
  EXPECT_EQ(test::run(push, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kApproachFailed);
  EXPECT_EQ(push.report()->explanation, "the start of the push is in a wall");
}

TEST(ExecutePush, asksForAPathThatEndsAlongThePush) {
  FakeWorld world(8);
  world.object = Pose2(0.0, 0.0, 1.0);
  PushConfiguration sideways = test::straightPush();
  sideways.object_T_robot = Pose2(-0.68, 0.0, -M_PI / 2);
  sideways.direction_rad = M_PI / 2;  // Object +x again.
  double direction_rad = 0.0;
  Pose2 goal;
  ExecutePush push = firstTrial(sideways, [&](const Observation& o, const Pose2& g, double d) {
    goal = g;
    direction_rad = d;
    return test::detour(o, g, d);
  });
  ASSERT_EQ(test::run(push, world), BehaviourStatus::kSucceeded) << push.describe();
  EXPECT_NEAR(direction_rad, 1.0, 0.05);
  EXPECT_LT(distance(goal, Pose2(0.0, 0.0, 1.0) * sideways.object_T_robot), 0.02);
}

TEST(ExecutePush, noticesThatTheObjectDidNotMove) {
  FakeWorld world(9);
  PushConfiguration beside = test::straightPush();
  beside.object_T_robot = Pose2(-0.68, -0.9, 0.0);
  ExecutePush push = firstTrial(beside);
  EXPECT_EQ(test::run(push, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kNotMoved);
  EXPECT_TRUE(isObservation(*push.report()));
  EXPECT_LT(push.report()->recorded.start_outcome.mean.position().norm(), 0.02);
}

TEST(ExecutePush, plansAnewWhenTheObjectIsMovedDuringTheApproach) {
  FakeWorld world(10);
  world.robot = Pose2(-3.0, 0.0, 0.0);
  int plans = 0;
  ExecutePush push = firstTrial(test::straightPush(), test::countedDetour(&plans));
  for (int i = 0; i < 100; ++i) {
    world.advance(push.tick(world.observe()).command.twist);
  }
  EXPECT_EQ(plans, 1);
  const Pose2 moved(0.4, 0.3, 0.5);
  world.object = moved;
  ASSERT_EQ(test::run(push, world), BehaviourStatus::kSucceeded) << push.describe();
  EXPECT_EQ(plans, 2);
  EXPECT_LT(distance(push.report()->map_T_start, moved), 0.01);
  const Pose2 start = push.report()->recorded.steps.front().object_T_robot;
  EXPECT_LT(distance(start, test::straightPush().object_T_robot), 0.02);
}

TEST(ExecutePush, plansAnewWhenAnotherObjectComesInSightOrMovesBesideItsWay) {
  FakeWorld world(10);
  world.robot = Pose2(-4.0, 0.0, 0.0);
  int plans = 0;
  ExecutePush push = firstTrial(test::straightPush(), test::countedDetour(&plans));
  ObjectState other;
  other.id = "chair_2";
  other.model = "disc";
  const auto driveOn = [&](std::optional<Pose2> map_T_other) {
    for (int i = 0; i < 20; ++i) {
      Observation observation = world.observe();
      if (map_T_other) {
        other.map_T_object = *map_T_other;
        other.stamp_s = observation.stamp_s;
        observation.objects.push_back(other);
      }
      world.advance(push.tick(observation).command.twist);
    }
    return plans;
  };
  EXPECT_EQ(driveOn({}), 1);
  EXPECT_EQ(driveOn(Pose2(-2.0, 5.0, 0.0)), 1);    // Far off.
  EXPECT_EQ(driveOn(Pose2(-2.0, 1.0, 0.0)), 2);    // Moved to the way's side.
  EXPECT_EQ(driveOn(Pose2(-2.05, 1.05, 0.1)), 2);  // Scatter.
  EXPECT_EQ(driveOn(Pose2(-2.0, 0.7, 0.0)), 3);
}

TEST(ExecutePush, docksAnewWhenDockingNudgedTheObjectButNotForEver) {
  for (const int nudges : {1, 100}) {
    FakeWorld world(11);
    ExecutePush push = firstTrial();
    int done = 0;
    bool was_docking = false;
    test::run(push, world, 120.0, [&](const Observation&, const Tick&) {
      const bool docking = push.phase() == Phase::kDock;
      const bool arrived =
          docking &&
          distance(world.robot, world.object * test::straightPush().object_T_robot) < 0.01;
      if (arrived && !was_docking && done < nudges) {
        world.object = world.object * Pose2(0.04, 0.03, 0.0);
        ++done;
      }
      was_docking = arrived;
    });
    const PushReport& report = *push.report();
    if (nudges == 1) {
      EXPECT_EQ(report.outcome, PushOutcome::kDone) << report.explanation;
      EXPECT_LT(distance(report.recorded.steps.front().object_T_robot,
                         test::straightPush().object_T_robot),
                0.02);
    } else {
      EXPECT_EQ(report.outcome, PushOutcome::kApproachFailed) << report.explanation;
    }
  }
}

TEST(ExecutePush, givesUpWhenSomethingBlocksTheRobot) {
  FakeWorld world(12);
  world.robot_blocked = true;
  ExecutePush push = firstTrial();
  EXPECT_EQ(test::run(push, world, 200.0), BehaviourStatus::kFailed);
  EXPECT_TRUE(push.report()->outcome == PushOutcome::kApproachFailed ||
              push.report()->outcome == PushOutcome::kTimeout);
}

TEST(ExecutePush, givesUpWhenTheObjectNeverRests) {
  FakeWorld world(13);
  ExecutePush push = firstTrial();
  ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
  world.deceleration_mps2 = 0.0;
  EXPECT_EQ(test::run(push, world), BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kTimeout);
  EXPECT_EQ(push.describe(), "chair_1 does not come to rest");
}

TEST(ExecutePush, failsWhenTimeGoesBack) {
  FakeWorld world(13);
  ExecutePush push = firstTrial();
  push.tick(world.observe());
  world.now_s = 1.0;
  const Tick tick = push.tick(world.observe());
  EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
  EXPECT_EQ(push.describe(), "time went back");
}

TEST(ExecutePush, testsThePredictionOfAReplay) {
  const Case learnt = learntCase(10);
  int rejected = 0;
  for (int seed = 1; seed <= 10; ++seed) {
    FakeWorld world(seed);
    world.scatter = 0.05;
    ExecutePush push = replay(learnt);
    ASSERT_EQ(test::run(push, world), BehaviourStatus::kSucceeded);
    const PushReport& report = *push.report();
    rejected += report.test.rejected ? 1 : 0;
    const Pose2 expected = report.map_T_start * learnt.start_outcome.mean;
    EXPECT_NEAR(distance(report.map_expected.mean, expected), 0.0, 1e-9);
  }
  EXPECT_LE(rejected, 1);

  FakeWorld slippery(3);
  slippery.deceleration_mps2 = 0.1;
  ExecutePush push = replay(learnt);
  ASSERT_EQ(test::run(push, slippery), BehaviourStatus::kSucceeded);
  EXPECT_TRUE(push.report()->test.rejected);
  EXPECT_LT(push.report()->test.p_value, 0.01);
  EXPECT_EQ(push.describe(), "chair_1 rests elsewhere than predicted");
}

TEST(ExecutePush, refusesBadOptionsAndCases) {
  ExecutePushOptions options;
  options.alpha = 2.0;
  options.dock_speed_mps = -1.0;
  try {
    ExecutePush("chair_1", test::straightPush(), fakeRobot(), test::detour, options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "push options: dock_speed_mps is -1, must be in [0.02, 5]; alpha is 2, must be in "
                 "[1e-09, 0.5]");
  }
  EXPECT_THROW(replay(Case{}), InputError);
}

}  // namespace
}  // namespace casepush
