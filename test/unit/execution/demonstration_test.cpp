#include "casepush/execution/demonstration.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "casepush/common/input_error.h"
#include "casepush/execution/execute_push.h"
#include "execution/fake_world.h"

namespace casepush {
namespace {

/// Somebody drives in the fake world while it is recorded.
struct Driver {
  Driver() { world.robot = Pose2(-1.0, 0.0, 0.0); }

  void drive(const Twist2& twist, double duration_s) {
    const double end_s = world.now_s + duration_s;
    while (world.now_s < end_s) {
      demonstration.add(world.observe());
      world.advance(twist);
    }
  }

  std::string refusal() const {
    const Demonstration::Result result = demonstration.result();
    EXPECT_FALSE(result.recorded);
    return result.explanation;
  }

  test::FakeWorld world{1};
  Demonstration demonstration{"chair_1", test::fakeObject(), test::fakeRobot()};
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Demonstration, becomesACaseThatIsTrimmedToTheContact) {
  Driver driver;
  driver.drive({}, 1.0);
  driver.drive({0.3, 0.0, 0.0}, 3.0);
  driver.drive({-0.3, 0.0, 0.0}, 2.0);
  driver.drive({}, 2.0);
  const Demonstration::Result result = driver.demonstration.result();
  ASSERT_TRUE(result.recorded) << result.explanation;
  const Case& recorded = *result.recorded;
  EXPECT_NO_THROW(validateCase(recorded, "demonstrated"));
  EXPECT_EQ(recorded.origin, CaseOrigin::kDemonstrated);
  EXPECT_EQ(recorded.object, "disc");
  EXPECT_EQ(recorded.robot, "disc_robot");
  EXPECT_EQ(recorded.observation_count, 1);
  // 0.35 m of free way before the contact and the way back are not part of it.
  EXPECT_GT(recorded.pushDurationS(), 1.5);
  EXPECT_LT(recorded.pushDurationS(), 2.7);
  const double clear_m = recorded.steps.front().object_T_robot.position().norm() -
                         test::kObjectRadiusM - test::kRobotRadiusM;
  EXPECT_GT(clear_m, 0.04);
  EXPECT_LT(clear_m, 0.2);
  EXPECT_NEAR(recorded.start_outcome.mean.x(), driver.world.object.x(), 0.02);
  EXPECT_NEAR(recorded.steps.back().start_T_object.x(), driver.world.object.x(), 0.02);
  // From standstill.
  EXPECT_LT(recorded.steps.front().action.speed(), 0.05);
  EXPECT_TRUE(contains(result.explanation, "moved chair_1 by"));
}

TEST(Demonstration, canBePractised) {
  Driver driver;
  driver.drive({0.25, 0.0, 0.0}, 3.5);
  driver.drive({}, 2.0);
  const Demonstration::Result result = driver.demonstration.result();
  ASSERT_TRUE(result.recorded) << result.explanation;
  test::FakeWorld world(7);
  ExecutePush push("chair_1", *result.recorded, test::fakeRobot(), test::detour, {});
  test::run(push, world);
  ASSERT_EQ(push.report()->outcome, PushOutcome::kDone) << push.report()->explanation;
  EXPECT_LT(
      distance(push.report()->recorded.start_outcome.mean, result.recorded->start_outcome.mean),
      0.1);
}

TEST(Demonstration, refusesWhatIsNoPush) {
  Driver unseen;
  unseen.world.object_visible = false;
  unseen.drive({0.3, 0.0, 0.0}, 2.0);
  EXPECT_TRUE(contains(unseen.refusal(), "chair_1 was not seen"));

  Driver idle;
  idle.drive({}, 2.0);
  EXPECT_TRUE(contains(idle.refusal(), "the robot did not move"));

  Driver beside;
  beside.drive({-0.3, 0.0, 0.0}, 2.0);
  EXPECT_TRUE(contains(beside.refusal(), "never moved"));

  Driver touching;
  touching.world.robot = Pose2(-0.66, 0.0, 0.0);
  touching.drive({0.3, 0.0, 0.0}, 2.0);
  touching.drive({}, 2.0);
  EXPECT_TRUE(contains(touching.refusal(), "touched chair_1 already"));
}

TEST(Demonstration, waitsForTheObjectToRest) {
  Driver driver;
  driver.drive({0.3, 0.0, 0.0}, 3.0);
  const Demonstration::Result early = driver.demonstration.result();
  EXPECT_TRUE(early.wait);
  EXPECT_TRUE(contains(early.explanation, "has not come to rest yet"));
  driver.drive({}, 2.5);
  EXPECT_TRUE(driver.demonstration.result().recorded);
}

TEST(Demonstration, refusesSeveralPushesAtOnce) {
  Driver driver;
  for (int i = 0; i < 2; ++i) {
    driver.drive({0.3, 0.0, 0.0}, 2.0);
    driver.drive({}, 2.0);
  }
  EXPECT_TRUE(contains(driver.refusal(), "more than once"));
}

TEST(Demonstration, refusesAnObjectOutOfSightWhileItIsPushed) {
  Driver driver;
  driver.drive({0.3, 0.0, 0.0}, 1.5);
  driver.world.object_visible = false;
  driver.drive({0.3, 0.0, 0.0}, 1.5);
  driver.world.object_visible = true;
  driver.drive({0.3, 0.0, 0.0}, 0.3);
  driver.drive({}, 2.0);
  EXPECT_TRUE(contains(driver.refusal(), "out of sight"));
}

TEST(Demonstration, refusesLongPushesAndRecordings) {
  Driver slow;
  slow.drive({0.1, 0.0, 0.0}, 22.0);
  slow.drive({}, 2.0);
  EXPECT_TRUE(contains(slow.refusal(), "the longest allowed is 15.0 s"));

  DemonstrationOptions brief;
  brief.max_recording_s = 2.0;
  Driver driver;
  driver.demonstration = Demonstration("chair_1", test::fakeObject(), test::fakeRobot(), brief);
  driver.drive({0.3, 0.0, 0.0}, 3.0);
  EXPECT_TRUE(contains(driver.refusal(), "longer than 2.0 s"));
}

TEST(Demonstration, refusesBadOptions) {
  DemonstrationOptions bad;
  bad.contact_gap_m = 2.0;
  EXPECT_THROW(Demonstration("chair_1", test::fakeObject(), test::fakeRobot(), bad), InputError);
}

}  // namespace
}  // namespace casepush
