#include "casepush/execution/object_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "execution/fake_world.h"

namespace casepush {
namespace {

CameraModel camera(double yaw_rad, double fov_rad) {
  CameraModel model;
  model.horizontal_fov_rad = fov_rad;
  Eigen::Matrix3d optical;
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  model.base_T_camera.linear() =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * optical;
  return model;
}

// The robot stands 1.5 m before the object and has just lost sight of it.
class ObjectSearchTest : public testing::Test {
 protected:
  ObjectSearchTest() {
    last_seen_ = *world_.observe().object("chair_1");
    world_.object_visible = false;
  }

  ObjectSearch search() { return {last_seen_, robot_, way_, options_}; }

  // Runs a search in a world where the object is seen only from where `visible` says.
  BehaviourStatus run(ObjectSearch& search, const std::function<bool(const Pose2&)>& visible) {
    const double began_s = world_.now_s;
    const BehaviourStatus status =
        test::run(search, world_, 200.0, [&](const Observation&, const Tick& tick) {
          world_.object_visible = visible(world_.robot);
          max_speed_mps_ = std::max(max_speed_mps_, tick.command.twist.speed());
        });
    duration_s_ = world_.now_s - began_s;
    EXPECT_TRUE(test::isZero(search.tick(world_.observe()).command.twist));
    return status;
  }

  test::FakeWorld world_{3};
  RobotModel robot_ = test::fakeRobot();
  ApproachPlanner way_ = test::detour;
  ObjectSearchOptions options_;
  ObjectState last_seen_;
  double max_speed_mps_ = 0.0;
  double duration_s_ = 0.0;
};

TEST_F(ObjectSearchTest, endsWithoutMovingIfTheObjectComesBackInTime) {
  ObjectSearch found = search();
  EXPECT_EQ(run(found, [this](const Pose2&) { return world_.now_s > 100.5; }),
            BehaviourStatus::kSucceeded);
  EXPECT_EQ(max_speed_mps_, 0.0);
  EXPECT_EQ(found.describe(), "chair_1 is in sight again");
}

TEST_F(ObjectSearchTest, turnsACameraToWhereTheObjectWas) {
  robot_.cameras = {camera(0.0, 1.0)};
  world_.robot = Pose2(-1.5, 0.0, 2.5);
  ObjectSearch found = search();
  const auto in_view = [](const Pose2& robot) { return std::abs(robot.yaw()) < 0.4; };
  EXPECT_EQ(run(found, in_view), BehaviourStatus::kSucceeded);
  EXPECT_LT(distance(world_.robot, Pose2(-1.5, 0.0, 0.0)), 0.1);
  EXPECT_LT(duration_s_, 8.0);
}

TEST_F(ObjectSearchTest, drivesToTheOtherSideOfWhatHidesTheObject) {
  world_.object = Pose2(1.2, 0.3, 1.0);
  ObjectSearch found = search();
  const auto behind = [](const Pose2& robot) { return robot.x() > 0.6; };
  EXPECT_EQ(run(found, behind), BehaviourStatus::kSucceeded);
  EXPECT_LT(duration_s_, 40.0);
  EXPECT_LE(max_speed_mps_, 0.5 + 1e-9);
}

TEST_F(ObjectSearchTest, givesUpAfterAllPlacesAndWithinTheTimeLimit) {
  options_.time_limit_s = 500.0;
  ObjectSearch all_places = search();
  EXPECT_EQ(run(all_places, [](const Pose2&) { return false; }), BehaviourStatus::kFailed);
  EXPECT_EQ(all_places.describe(),
            "chair_1 is not in sight, looked for from 12 places around where it was last seen");
  options_.time_limit_s = 12.0;
  ObjectSearch short_time = search();
  EXPECT_EQ(run(short_time, [](const Pose2&) { return false; }), BehaviourStatus::kFailed);
  EXPECT_NEAR(duration_s_, 12.0, 0.1);
}

TEST_F(ObjectSearchTest, leavesPlacesOutThatCanNotBeReached) {
  int asked = 0;
  way_ = [&asked](const Observation& observation, const Pose2&, double) {
    ++asked;
    EXPECT_NE(observation.object("chair_1"), nullptr);
    return RobotPath();
  };
  ObjectSearch nowhere = search();
  EXPECT_EQ(run(nowhere, [](const Pose2&) { return false; }), BehaviourStatus::kFailed);
  EXPECT_LT(duration_s_, 3.0);
  EXPECT_EQ(max_speed_mps_, 0.0);
  EXPECT_EQ(asked, 22);
  EXPECT_NE(nowhere.describe().find("from 1 place around"), std::string::npos);
}

TEST_F(ObjectSearchTest, looksForAnotherWayWhenSomethingComesInSightBesideIt) {
  int asked = 0;
  way_ = test::countedDetour(&asked);
  ObjectSearch on_the_way = search();
  while (asked == 0 || max_speed_mps_ < 0.3) {
    const Tick tick = on_the_way.tick(world_.observe());
    max_speed_mps_ = std::max(max_speed_mps_, asked > 0 ? tick.command.twist.speed() : 0.0);
    world_.advance(tick.command.twist);
  }
  EXPECT_EQ(asked, 1);
  for (int i = 0; i < 10; ++i) {
    Observation observation = world_.observe();
    ObjectState other = last_seen_;
    other.id = "chair_2";
    other.map_T_object = world_.robot * Pose2(1.0, 0.5, 0.0);
    observation.objects.push_back(other);
    world_.advance(on_the_way.tick(observation).command.twist);
  }
  EXPECT_EQ(asked, 2);
}

TEST_F(ObjectSearchTest, doesNotPressAgainstWhatHoldsTheRobot) {
  world_.robot_blocked = true;
  ObjectSearch held = search();
  EXPECT_EQ(run(held, [](const Pose2&) { return false; }), BehaviourStatus::kFailed);
  EXPECT_LT(duration_s_, 20.0);
}

TEST_F(ObjectSearchTest, standsWhileTheRobotsPoseIsStale) {
  ObjectSearch lost = search();
  for (int i = 0; i < 200; ++i) {
    world_.advance(lost.tick(world_.observe()).command.twist);
  }
  world_.robot_localised = false;
  for (int i = 0; i < 50; ++i) {
    const Tick tick = lost.tick(world_.observe());
    if (i > 8) {
      EXPECT_TRUE(test::isZero(tick.command.twist));
    }
    world_.advance(tick.command.twist);
  }
}

TEST(ViewingYaw, turnsTheNearestCameraNoMoreThanItMust) {
  RobotModel robot;
  const Eigen::Vector2d behind(-2.0, 0.0);
  EXPECT_NEAR(std::abs(viewingYaw(robot, Pose2(), behind)), M_PI, 1e-9);
  EXPECT_NEAR(viewingYaw(robot, Pose2(0.0, 0.0, 0.2), {2.0, 0.0}), 0.2, 1e-9);
  robot.cameras = {camera(0.0, 1.0), camera(M_PI / 2.0, 1.0)};
  // The left camera has 90 degrees to go, the front one 180.
  EXPECT_NEAR(viewingYaw(robot, Pose2(), behind), M_PI / 2.0, 1e-9);
  EXPECT_NEAR(viewingYaw(robot, Pose2(0.0, 0.0, 1.4), behind), 1.4, 1e-9);
}

}  // namespace
}  // namespace casepush
