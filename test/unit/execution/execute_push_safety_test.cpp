#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "execution/pushes.h"

namespace casepush {
namespace {

using test::fakeRobot;
using test::FakeWorld;
using test::firstTrial;
using Phase = ExecutePush::Phase;

Case preciseCase() {
  FakeWorld world(6);
  ExecutePush first = firstTrial();
  EXPECT_EQ(test::run(first, world), BehaviourStatus::kSucceeded);
  Case known = first.report()->recorded;
  known.start_outcome.covariance = Eigen::Vector3d(0.02, 0.02, 0.05).cwiseAbs2().asDiagonal();
  known.effective_count = 20;
  return known;
}

TEST(ExecutePushSafety, stopsAtOnceWhenTheRobotsPoseIsStaleAndGoesOnAfterwards) {
  for (const Phase phase : {Phase::kApproach, Phase::kDock, Phase::kPush}) {
    FakeWorld world(4);
    ExecutePush push = firstTrial();
    ASSERT_TRUE(test::runUntil(push, world, phase));
    for (int i = 0; i < 20; ++i) {
      world.advance(push.tick(world.observe()).command.twist);
    }
    world.robot_localised = false;
    const double lost_s = world.now_s;
    while (world.now_s < lost_s + 1.0) {
      const Tick tick = push.tick(world.observe());
      if (world.now_s > lost_s + 0.16) {
        EXPECT_TRUE(test::isZero(tick.command.twist));
      }
      EXPECT_EQ(tick.status, BehaviourStatus::kRunning);
      world.advance(tick.command.twist);
    }
    world.robot_localised = true;
    // What would become of an object that rolled on while the robot stood is no push of the case.
    const bool pushed = phase == Phase::kPush;
    EXPECT_EQ(test::run(push, world),
              pushed ? BehaviourStatus::kFailed : BehaviourStatus::kSucceeded)
        << push.describe();
    EXPECT_EQ(isObservation(*push.report()), !pushed);
  }
}

TEST(ExecutePushSafety, startsFromAStandstillAfterAPauseWithoutTicks) {
  for (const Phase phase : {Phase::kApproach, Phase::kPush}) {
    FakeWorld world(4);
    ExecutePush push = firstTrial();
    ASSERT_TRUE(test::runUntil(push, world, phase));
    for (int i = 0; i < 20; ++i) {
      world.advance(push.tick(world.observe()).command.twist);
    }
    for (int i = 0; i < 50; ++i) {
      world.advance(Twist2{});
    }
    const Tick tick = push.tick(world.observe());
    EXPECT_LE(tick.command.twist.speed(), fakeRobot().limits.max_acceleration_mps2 * 0.2 + 1e-9);
    if (phase == Phase::kPush) {
      EXPECT_EQ(push.report()->outcome, PushOutcome::kTimeout);
      EXPECT_EQ(push.describe(), "the push of chair_1 was interrupted");
    }
  }
}

TEST(ExecutePushSafety, failsWhenTheRobotsPoseStaysAway) {
  FakeWorld world(4);
  ExecutePush push = firstTrial();
  ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
  world.robot_localised = false;
  const double lost_s = world.now_s;
  EXPECT_EQ(test::run(push, world, 10.0), BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kRobotLost);
  EXPECT_EQ(push.describe(), "the robot's own pose is not up to date");
  EXPECT_NEAR(world.now_s - lost_s, 2.2, 0.1);
}

TEST(ExecutePushSafety, stopsAndFailsWhenTheObjectIsLost) {
  for (const Phase phase : {Phase::kPush, Phase::kRest}) {
    FakeWorld world(5);
    ExecutePush push = firstTrial();
    ASSERT_TRUE(test::runUntil(push, world, phase));
    world.object_visible = false;
    const double lost_s = world.now_s;
    EXPECT_EQ(test::run(push, world, 10.0), BehaviourStatus::kFailed);
    EXPECT_EQ(push.report()->outcome, PushOutcome::kObjectLost);
    EXPECT_NEAR(world.now_s - lost_s, phase == Phase::kPush ? 0.3 : 1.0, 0.07);
    EXPECT_TRUE(test::isZero(push.tick(world.observe()).command.twist));
    EXPECT_FALSE(isObservation(*push.report()));
  }
}

TEST(ExecutePushSafety, failsWhenTheObjectIsNeverSeen) {
  FakeWorld world(5);
  world.object_visible = false;
  ExecutePush push = firstTrial();
  EXPECT_EQ(test::run(push, world, 10.0), BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kObjectLost);
  EXPECT_EQ(push.describe(), "chair_1 has not been seen");
}

TEST(ExecutePushSafety, aBriefLossOfSightDoesNotMatter) {
  FakeWorld world(5);
  ExecutePush push = firstTrial();
  ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
  world.object_visible = false;
  for (int i = 0; i < 11; ++i) {
    world.advance(push.tick(world.observe()).command.twist);
  }
  world.object_visible = true;
  EXPECT_EQ(test::run(push, world), BehaviourStatus::kSucceeded);
}

TEST(ExecutePushSafety, failsAtOnceWhenSomethingHoldsTheRobotOnItsWay) {
  for (const Phase phase : {Phase::kApproach, Phase::kDock}) {
    FakeWorld world(8);
    ExecutePush push = firstTrial();
    ASSERT_TRUE(test::runUntil(push, world, phase));
    for (int i = 0; i < 20; ++i) {
      world.advance(push.tick(world.observe()).command.twist);
    }
    world.robot_blocked = true;
    const double held_s = world.now_s;
    EXPECT_EQ(test::run(push, world, 10.0), BehaviourStatus::kFailed);
    EXPECT_EQ(push.report()->outcome, PushOutcome::kApproachFailed);
    // The slower the robot, the longer until it should have moved further than poses are off.
    EXPECT_LT(world.now_s - held_s, phase == Phase::kApproach ? 0.25 : 0.8);
    EXPECT_NE(push.describe().find("something unknown holds the robot at (-"), std::string::npos)
        << push.describe();
  }
}

TEST(ExecutePushSafety, standsStillOnObservationsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Observation&)>> spoilers = {
      [nan](Observation& o) { o.stamp_s = nan; },
      [nan](Observation& o) { o.map_T_robot = Pose2(nan, 0.0, 0.0); },
      [nan](Observation& o) { o.robot_stamp_s = nan; },
      [nan](Observation& o) { o.objects[0].map_T_object = Pose2(0.0, 0.0, nan); },
      [nan](Observation& o) { o.objects[0].twist.vx_mps = nan; },
  };
  for (const Phase phase : {Phase::kApproach, Phase::kDock, Phase::kPush, Phase::kRest}) {
    FakeWorld world(6);
    ExecutePush push = firstTrial();
    ASSERT_TRUE(test::runUntil(push, world, phase));
    world.advance(push.tick(world.observe()).command.twist);
    for (const auto& spoil : spoilers) {
      Observation bad = world.observe();
      spoil(bad);
      const Tick tick = push.tick(bad);
      EXPECT_TRUE(test::isZero(tick.command.twist));
      EXPECT_EQ(tick.status, BehaviourStatus::kRunning);
      world.advance(push.tick(world.observe()).command.twist);
    }
    EXPECT_EQ(test::run(push, world), BehaviourStatus::kSucceeded) << push.describe();
  }
}

TEST(ExecutePushSafety, cancelsInEveryPhase) {
  for (const Phase phase : {Phase::kApproach, Phase::kDock, Phase::kPush, Phase::kRest}) {
    FakeWorld world(7);
    ExecutePush push = firstTrial();
    ASSERT_TRUE(test::runUntil(push, world, phase));
    push.cancel();
    for (int i = 0; i < 3; ++i) {
      const Tick tick = push.tick(world.observe());
      EXPECT_TRUE(test::isZero(tick.command.twist));
      EXPECT_EQ(tick.status, BehaviourStatus::kFailed);
    }
    EXPECT_EQ(push.report()->outcome, PushOutcome::kCancelled);
  }
}

TEST(ExecutePushSafety, cancelBeforeTheFirstTickWorksToo) {
  ExecutePush push = firstTrial();
  push.cancel();
  EXPECT_EQ(push.tick(Observation{}).status, BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kCancelled);
}

TEST(ExecutePushSafety, breaksOffWithinTenthsOfASecondIfTheObjectIsHeld) {
  const Case known = preciseCase();
  for (const bool on : {true, false}) {
    ExecutePushOptions options;
    options.tube.on = on;
    FakeWorld world(7);
    ExecutePush push("chair_1", known, test::fakeRobot(), test::detour, options);
    ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
    const double began_s = world.now_s;
    world.object_fixed = true;
    test::runUntil(push, world, Phase::kRest);
    const double pushed_s = world.now_s - began_s;
    test::run(push, world);
    const PushReport& report = *push.report();
    EXPECT_TRUE(isObservation(report));
    EXPECT_TRUE(report.test.rejected);
    if (on) {
      EXPECT_LT(pushed_s, 1.2);
      EXPECT_EQ(report.outcome, PushOutcome::kBrokenOff);
      EXPECT_LT(report.test.p_value, 1e-4);
      EXPECT_NE(report.explanation.find("off its course"), std::string::npos);
    } else {
      EXPECT_GT(pushed_s, 1.9);
      EXPECT_EQ(report.outcome, PushOutcome::kNotMoved);
    }
  }
}

TEST(ExecutePushSafety, stopsBeforeTheObjectTouchesSomething) {
  FakeWorld world(6);
  ExecutePush first = firstTrial();
  ASSERT_EQ(test::run(first, world), BehaviourStatus::kSucceeded);
  const double whole_m = first.report()->map_T_end.x();
  double free_m = 100.0;
  const TouchCheck check = [&](const Observation&, const std::vector<Pose2>& map_T_object) {
    const bool touches = std::any_of(map_T_object.begin(), map_T_object.end(),
                                     [&](const Pose2& pose) { return pose.x() > free_m; });
    return std::string(touches ? "cart_1" : "");
  };
  for (const bool on : {true, false}) {
    ExecutePushOptions options;
    options.watch_ahead = on;
    world = FakeWorld(7);
    free_m = 100.0;
    ExecutePush push("chair_1", first.report()->recorded, test::fakeRobot(), test::detour, options);
    push.watchAhead(check);
    ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
    free_m = 0.7 * whole_m;  // Somebody put a cart there.
    test::run(push, world);
    const PushReport& report = *push.report();
    if (on) {
      EXPECT_EQ(report.outcome, PushOutcome::kStoppedShort);
      EXPECT_EQ(push.describe(), "stopped before chair_1 touched cart_1");
      EXPECT_LT(world.object.x(), free_m);
      EXPECT_LT(world.object_velocity.speed(), 0.02);  // It was waited for.
      EXPECT_FALSE(isObservation(report));
      EXPECT_FALSE(report.test.rejected);
    } else {
      EXPECT_EQ(report.outcome, PushOutcome::kDone);
      EXPECT_GT(world.object.x(), free_m);
    }
  }
}

TEST(ExecutePushSafety, anObjectThatIsStoppedOffItsCourseTellsThatTheCaseIsWrong) {
  const Case known = preciseCase();
  ExecutePushOptions options;
  options.tube.on = true;
  options.tube.hold_s = 5.0;  // Without the stop it would go on.
  FakeWorld world(7);
  ExecutePush push("chair_1", known, test::fakeRobot(), test::detour, options);
  bool is_there = false;
  push.watchAhead([&](const Observation&, const std::vector<Pose2>&) {
    return std::string(is_there ? "the wall" : "");
  });
  ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
  world.object_fixed = true;
  for (int i = 0; i < 60; ++i) world.advance(push.tick(world.observe()).command.twist);
  is_there = true;
  test::run(push, world);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kBrokenOff);
  EXPECT_TRUE(push.report()->test.rejected);
  EXPECT_EQ(push.describe().rfind("stopped before chair_1 touched the wall: chair_1 was", 0), 0u)
      << push.describe();
}

TEST(ExecutePushSafety, stopsWhenSomethingHoldsTheRobot) {
  FakeWorld world(8);
  ExecutePush push = firstTrial();
  ASSERT_TRUE(test::runUntil(push, world, Phase::kPush));
  const double held_s = world.now_s;
  world.robot_blocked = true;
  EXPECT_EQ(test::run(push, world, 10.0), BehaviourStatus::kFailed);
  EXPECT_EQ(push.report()->outcome, PushOutcome::kBlocked);
  EXPECT_LT(world.now_s - held_s, 1.7);
  EXPECT_EQ(push.describe(), "something holds the robot while it pushes chair_1");
  EXPECT_FALSE(isObservation(*push.report()));
}

}  // namespace
}  // namespace casepush
