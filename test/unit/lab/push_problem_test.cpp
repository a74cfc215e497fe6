#include <gtest/gtest.h>

#include <cmath>

#include "casepush/lab/push_run.h"
#include "push_ways.h"

namespace casepush {
namespace {

WorldModel withBoxes(WorldModel world, const std::vector<StaticBox>& boxes) {
  world.boxes.insert(world.boxes.end(), boxes.begin(), boxes.end());
  return world;
}

StaticBox makeWall(const std::string& name, double size_x, double size_y, double x, double y) {
  StaticBox box;
  box.name = name;
  box.box.size_m << size_x, size_y, 1.5;
  box.map_T_box.translation() << x, y, 0.75;
  return box;
}

class PushWaysOfABox : public testing::Test {
 protected:
  bool lead(const WorldModel& world, const Pose2& start, const Pose2& goal) const {
    const std::shared_ptr<const Map> map = surveyMap(world);
    const CollisionChecker checker(*map);
    return PushWays(checker, object_, robot_).lead(start, goal);
  }

  const Catalog catalog_ = Catalog::standard();
  const WorldModel floor_ = catalog_.world("open_floor");  // Walls 4.9 m from the origin.
  const ObjectModel object_ = catalog_.object("sliding_box");
  const RobotModel robot_ = catalog_.robot("cobot");
};

TEST_F(PushWaysOfABox, crossOpenFloor) {
  EXPECT_TRUE(lead(floor_, Pose2(-2.0, -2.0, 0.4), Pose2(3.0, 2.0, 1.0)));
}

TEST_F(PushWaysOfABox, doNotLeaveACornerOrAWall) {
  const double at_wall_m = 4.9 - object_.radius_m - 0.25;
  EXPECT_FALSE(lead(floor_, Pose2(at_wall_m, at_wall_m, 0.0), Pose2()));
  EXPECT_FALSE(lead(floor_, Pose2(at_wall_m, 0.0, 0.0), Pose2()));
  EXPECT_TRUE(lead(floor_, Pose2(), Pose2(at_wall_m, at_wall_m, 0.0))) << "but lead there";
  const double roomy_m = 4.9 - object_.radius_m - 2.0 * robot_.radius_m - 0.2;
  EXPECT_TRUE(lead(floor_, Pose2(roomy_m, roomy_m, 0.0), Pose2()));
}

// Where the robot would touch the wall with its back and the object with its front.
TEST_F(PushWaysOfABox, doNotStartWithoutPlayForTheRobot) {
  EXPECT_FALSE(lead(floor_, Pose2(4.01, 4.33, 2.74), Pose2(-1.04, -2.35, 0.64)));
}

TEST_F(PushWaysOfABox, followACorridorButNotAroundABendWithoutRoomBehind) {
  // 1.2 m wide along x at y = 0; at x = 3 it bends north.
  const auto corridor = [&](double end_x) {
    return withBoxes(
        floor_, {makeWall("south", 9.0, 0.1, 0.0, -0.65), makeWall("north", 6.8, 0.1, -1.0, 0.65),
                 makeWall("end", 0.1, 5.0, end_x, 1.8)});
  };
  EXPECT_TRUE(lead(corridor(3.65), Pose2(-3.0, 0.0, 0.0), Pose2(2.0, 0.0, 0.0)));
  EXPECT_FALSE(lead(corridor(3.65), Pose2(-3.0, 0.0, 0.0), Pose2(3.0, 2.5, 0.0)));
}

class RandomProblems : public testing::TestWithParam<std::string> {};

TEST_P(RandomProblems, leaveTheRobotRoomBehindTheObject) {
  const Catalog catalog = Catalog::standard();
  for (const std::string object : {"sliding_box", "utility_cart"}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      SCOPED_TRACE(object + ", seed " + std::to_string(seed));
      const PushProblem problem = randomProblem(catalog, catalog.world(GetParam()), object, seed);
      const std::shared_ptr<const Map> map = surveyMap(problem.world);
      const CollisionChecker checker(*map);
      const RobotModel robot = catalog.robot(problem.world.robot);
      for (const ObjectPlacement& placement : problem.world.objects) {
        if (placement.id != problem.object_id) continue;
        const ObjectModel model = catalog.object(placement.model);
        const Pose2& start = placement.map_T_object;
        EXPECT_TRUE(PushWays(checker, model, robot).lead(start, problem.map_T_goal));
        // Somewhere behind it there is room from which a push leads half a metre away from there.
        const auto footprint = checker.footprint(robot.solid);
        int free = 0;
        for (int i = 0; i < 16; ++i) {
          const double bearing = 2.0 * M_PI * i / 16;
          const double reach_m = model.radius_m + robot.radius_m;
          const Pose2 away(start.x(), start.y(), bearing);
          const bool behind = !checker.collides(*footprint, away * Pose2(-reach_m, 0.0, 0.0));
          const bool ahead =
              !checker.collides(*checker.footprint(model.solid),
                                Pose2((away * Pose2(0.5, 0.0, 0.0)).x(),
                                      (away * Pose2(0.5, 0.0, 0.0)).y(), start.yaw()));
          free += behind && ahead ? 1 : 0;
        }
        EXPECT_GE(free, 1);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RandomProblems, testing::Values("open_floor", "corridor"),
                         [](const auto& world) { return world.param; });

}  // namespace
}  // namespace casepush
