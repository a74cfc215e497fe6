#include "planning/approach_check.h"

#include <gtest/gtest.h>

#include "planning/furnished_room.h"
#include "planning/origin_distance.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

struct Scene {
  explicit Scene(const WorldModel& world) : map(mapOf(world)), checker(*map) {}

  std::shared_ptr<const Map> map;
  CollisionChecker checker;
  RobotModel robot = testRobot();
  ObjectModels objects = {{"chair", testChair()}};
  RobotPathOptions options;
};

/// The quick check and the path planner, which is the truth, with pushes to approach.
struct Comparison : Scene {
  using Scene::Scene;

  RobotPathPlanner paths{robot, options};
  ApproachLibrary library{checker, robot, objects, options};
  ClearanceGrid grid{checker.columns(), library.discs()};
  ApproachCheck check{&library, grid, checker, {}};
  std::shared_ptr<const Footprint> object = checker.footprint(testChair().solid);
  std::vector<PreparedCase> cases =
      prepareCases(syntheticPushes(6, 5), 0.0, 0.025, testChair().radius_m, robot.radius_m);
};

// What the quick check says yes to, the path planner must find.
TEST(ApproachCheck, isSufficient) {
  Comparison scene(furnishedRoom());
  Random random(4);
  int accepted = 0;
  int found = 0;
  for (int i = 0; i < 150; ++i) {
    const Pose2 pose = randomFreePose(scene.checker, *scene.object, &random);
    const PreparedCase& previous = scene.cases[random.below(scene.cases.size())];
    const PreparedCase& next = scene.cases[random.below(scene.cases.size())];
    CollisionChecker standing = scene.checker;
    standing.setObstacles({{testChair().solid, pose}});
    const bool truth = scene.paths
                           .plan(standing, pose * previous.outcome_T_robot, pose * next.robot_begin,
                                 pose.yaw() + next.push_direction_rad)
                           .found;
    const bool quick = scene.check.canFollow({"", "chair", pose}, previous, next);
    EXPECT_TRUE(truth || !quick) << pose.x() << " " << pose.y();
    accepted += quick;
    found += truth;
  }
  EXPECT_GT(accepted, found / 2);
  EXPECT_LT(found, 150);
}

// From anywhere, some places shut off; whatever was asked before.
TEST(ApproachCheck, reachesFromAfarWhatThePathPlannerReaches) {
  WorldModel world = furnishedRoom();
  world.boxes.push_back(standing("screen", 1.5, 13.0, 2.8, 0.1, 1.5));
  world.boxes.push_back(standing("other_screen", 2.9, 14.0, 0.1, 2.0, 1.5));
  Comparison scene(world);
  Random random(4);
  int accepted = 0;
  int found = 0;
  int all = 0;
  for (int i = 0; i < 12; ++i) {
    const Pose2 pose = randomFreePose(scene.checker, *scene.object, &random);
    const Pose2 robot =
        i % 3 == 0 ? Pose2(1.5, 14.0, 0.0) : randomFreePose(scene.checker, *scene.object, &random);
    CollisionChecker standing = scene.checker;
    standing.setObstacles({{testChair().solid, pose}});
    for (const PreparedCase& next : scene.cases) {
      const bool truth =
          scene.paths
              .plan(standing, robot, pose * next.robot_begin, pose.yaw() + next.push_direction_rad)
              .found;
      const bool quick = scene.check.canReach({"", "chair", pose}, robot, next);
      EXPECT_TRUE(truth || !quick) << pose.x() << " " << pose.y();
      accepted += quick;
      found += truth;
      ++all;
    }
  }
  EXPECT_GT(accepted, 0.8 * found);
  EXPECT_GT(found, all / 3);
  EXPECT_LT(found, 0.9 * all);
}

// What a check knew of cases is for these very cases only.
TEST(ApproachCheck, answersTheSameWithWhatAnotherOneKnew) {
  Comparison scene(furnishedRoom());
  Random random(6);
  for (int seed = 5; seed < 8; ++seed) {
    const auto cases = std::make_shared<const std::vector<PreparedCase>>(prepareCases(
        syntheticPushes(6, seed), 0.0, 0.025, testChair().radius_m, scene.robot.radius_m));
    for (int round = 0; round < 2; ++round) {
      ApproachCheck check(&scene.library, scene.grid, scene.checker, {}, Patience(), cases);
      for (int i = 0; i < 60; ++i) {
        const Pose2 pose = randomFreePose(scene.checker, *scene.object, &random);
        const PreparedCase& previous = (*cases)[random.below(cases->size())];
        const PreparedCase& next = (*cases)[random.below(cases->size())];
        ApproachCheck fresh(&scene.library, scene.grid, scene.checker, {});
        EXPECT_EQ(check.canFollow({"", "chair", pose}, previous, next),
                  fresh.canFollow({"", "chair", pose}, previous, next));
      }
    }
  }
}

TEST(RobotPathPlanner, endsWhenStopped) {
  Scene scene(emptyRoom());
  const PreparedCase push = prepareCase(syntheticPushes(1, 5).front(), 0.0, 0.025,
                                        testChair().radius_m, scene.robot.radius_m);
  bool is_over = false;
  RobotPathPlanner paths(scene.robot, scene.options);
  const auto stop = [&is_over] { return is_over; };
  const Pose2 goal = Pose2(3.0, 3.0, 0.0) * push.robot_begin;
  EXPECT_TRUE(paths.plan(scene.checker, Pose2(12.0, 12.0, 0.0), goal, 0.0, stop).found);
  is_over = true;
  const RobotPath path = paths.plan(scene.checker, Pose2(12.0, 12.0, 0.0), goal, 0.0, stop);
  EXPECT_FALSE(path.found);
  EXPECT_EQ(path.explanation, "stopped before a path was found");
}

TEST(OriginDistance, isALowerBoundAndSeesWalls) {
  Scene scene(furnishedRoom());
  const Eigen::Vector2d goal(11.5, 3.0);
  const OriginDistance map(scene.checker.columns(), testChair().solid, goal, 0.2);
  EXPECT_LE(map.at({11.0, 1.5}), (Eigen::Vector2d(11.0, 1.5) - goal).norm());
  // From the other side of the southern partition the way leads around it.
  const double straight_m = (Eigen::Vector2d(5.0, 2.0) - goal).norm();
  EXPECT_GT(map.at({5.0, 2.0}), straight_m + 0.3);
  EXPECT_NEAR(map.at(goal), 0.0, 1e-9);
}

TEST(OriginDistance, isInfiniteBehindClosedWalls) {
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("wall", 7.5, 7.5, 0.2, 15.0, 1.5));
  Scene scene(world);
  const OriginDistance map(scene.checker.columns(), testChair().solid, {11.0, 7.0}, 0.2);
  EXPECT_TRUE(std::isinf(map.at({4.0, 7.0})));
  EXPECT_FALSE(std::isinf(map.at({9.0, 7.0})));
}

}  // namespace
}  // namespace casepush
