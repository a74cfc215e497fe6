#include "casepush/planning/push_checker.h"

#include <gtest/gtest.h>

#include "planning/furnished_room.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

constexpr double kStep_m = 0.025;

struct Scene {
  explicit Scene(const WorldModel& world) : map(mapOf(world)), checker(*map) {}

  PushChecker pushChecker() const {
    return PushChecker(checker, {object, chair.radius_m}, {robot_footprint, robot.radius_m});
  }
  PreparedCase prepare(const Case& push_case, double zeta) const {
    return prepareCases({push_case}, zeta, kStep_m, chair.radius_m, robot.radius_m).front();
  }

  std::shared_ptr<const Map> map;
  CollisionChecker checker;
  ObjectModel chair = testChair();
  RobotModel robot = testRobot();
  std::shared_ptr<const Footprint> object = checker.footprint(chair.solid);
  std::shared_ptr<const Footprint> robot_footprint = checker.footprint(robot.solid);
};

WorldModel roomWith(const StaticBox& box) {
  WorldModel world = emptyRoom();
  world.boxes.push_back(box);
  return world;
}

TEST(PushChecker, agreesWithTestingEveryPose) {
  const Scene scene(furnishedRoom());
  PushChecker checker = scene.pushChecker();
  Random random(3);
  int safe = 0;
  const std::vector<Case> cases = syntheticPushes(6, 5);
  for (int k = 0; k < 600; ++k) {
    const PreparedCase push = scene.prepare(cases[k % cases.size()], 3.0);
    const Pose2 start = randomFreePose(scene.checker, *scene.object, &random);
    bool collides = scene.checker.collides(*scene.object, start * push.start_outcome.mean);
    for (const Pose2& pose : push.start_T_sigma) {
      collides = collides || scene.checker.collides(*scene.object, start * pose);
    }
    for (const Pose2& pose : push.start_T_object) {
      collides = collides || scene.checker.collides(*scene.object, start * pose);
    }
    for (const Pose2& pose : push.start_T_robot) {
      collides = collides || scene.checker.collides(*scene.robot_footprint, start * pose);
    }
    ASSERT_EQ(checker.conflict(push, start) != PushConflict::kNone, collides) << k;
    safe += collides ? 0 : 1;
  }
  EXPECT_GT(safe, 60);
  EXPECT_LT(safe, 540);
}

TEST(PushChecker, seesAThinObstacleOnTheObjectsWay) {
  // A post between start and outcome, so thin that only the way in between touches it.
  const Scene scene(roomWith(standing("post", 5.55, 5.0, 0.02, 0.02, 0.1)));
  PushChecker checker = scene.pushChecker();
  SyntheticPushOptions fast;
  fast.speed_mps = 0.6;
  fast.contact_radius_m = 2.5;  // The robot stays behind the post.
  const PreparedCase push = scene.prepare(syntheticPush(1, 0.0, 2.0, 0.0, fast), 3.0);
  EXPECT_EQ(checker.conflict(push, Pose2(5.0, 5.0, 0.0)), PushConflict::kObjectMotion);
  EXPECT_EQ(checker.conflict(push, Pose2(5.0, 7.0, 0.0)), PushConflict::kNone);
}

TEST(PushChecker, seesWhereTheRobotDoesNotFit) {
  const Scene scene(roomWith(standing("behind", 4.0, 5.0, 0.2, 0.2, 1.0)));
  PushChecker checker = scene.pushChecker();
  const PreparedCase push = scene.prepare(syntheticPush(1, 0.0, 2.0, 0.0, {}), 3.0);
  EXPECT_EQ(checker.conflict(push, Pose2(5.0, 5.0, 0.0)), PushConflict::kRobotMotion);
}

TEST(PushChecker, countsTheUncertaintyOfTheOutcome) {
  // The mean outcome passes the box by 5 cm, three standard deviations do not.
  const Scene scene(roomWith(standing("beside", 5.6, 5.45, 0.2, 0.2, 1.0)));
  PushChecker checker = scene.pushChecker();
  const Case push_case = syntheticPush(1, 0.0, 2.0, 0.0, {});
  const Pose2 start(5.0, 5.0, 0.0);
  EXPECT_EQ(checker.conflict(scene.prepare(push_case, 3.0), start), PushConflict::kOutcome);
  EXPECT_EQ(checker.conflict(scene.prepare(push_case, 0.0), start), PushConflict::kNone);
}

TEST(PushChecker, letsAnObjectAtAWallAwayButNotDeeper) {
  const Scene scene(emptyRoom());
  PushChecker checker = scene.pushChecker();
  // The wall's inner face is at y = 0.1; the chair overlaps it by 2 cm.
  const Pose2 start(5.0, 0.38, 0.0);
  ASSERT_TRUE(scene.checker.collides(*scene.object, start));
  SyntheticPushOptions aside;
  aside.contact_radius_m = 0.7;
  const PreparedCase away = scene.prepare(syntheticPush(1, 0.8, 2.0, 0.0, aside), 3.0);
  PreparedCase robot_free = away;
  robot_free.start_T_robot = {Pose2(0.0, 3.0, 0.0)};
  EXPECT_EQ(checker.conflict(robot_free, start), PushConflict::kObjectMotion);
  EXPECT_FALSE(checker.isFree(start));
  checker.tolerateStart(start);
  EXPECT_EQ(checker.conflict(robot_free, start), PushConflict::kNone);
  EXPECT_TRUE(checker.isFree(start));
  PreparedCase deeper = robot_free;
  deeper.start_T_object.push_back(Pose2(0.0, -0.02, 0.0));
  EXPECT_EQ(checker.conflict(deeper, start), PushConflict::kObjectMotion);
}

}  // namespace
}  // namespace casepush
