#include "casepush/lab/room_generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <set>

#include "casepush/lab/push_run.h"
#include "casepush/planning/robot_path_planner.h"
#include "casepush/sim/simulator.h"
#include "casepush/world/collision_checker.h"
#include "common/input_error_text.h"
#include "common/temporary_folder.h"

namespace casepush {
namespace {

RoomOptions roomFor(const std::string& object, std::uint64_t seed, double density = 0.1,
                    double size_m = 10.0) {
  RoomOptions options;
  options.object = object;
  options.seed = seed;
  options.density = density;
  options.size_m = size_m;
  return options;
}

/// What pieces of furniture cover, relative to the room: boxes that are neither walls nor legs.
double densityOf(const WorldModel& room) {
  double covered_m2 = 0.0;
  for (const StaticBox& box : room.boxes) {
    const bool counts =
        box.name.rfind("wall", 0) != 0 && box.name.find("_leg_") == std::string::npos;
    if (counts) covered_m2 += box.box.size_m.head<2>().prod();
  }
  return covered_m2 / (room.max_m - room.min_m).prod();
}

/// A disc as wide and as high as the object at any heading.
Solid spinning(const ObjectModel& object) {
  const double high_m = heightRange(object.solid).high_m;
  PlacedShape shape;
  shape.shape = Cylinder{object.radius_m, high_m};
  shape.frame_T_shape.translation().z() = 0.5 * high_m;
  return {shape};
}

/// Flood fill over cells of 10 cm.
bool isConnected(const CollisionChecker& checker, const Footprint& footprint, const Pose2& from,
                 const Pose2& to) {
  constexpr double kCell_m = 0.1;
  std::set<std::pair<int, int>> seen{{0, 0}};
  std::deque<std::pair<int, int>> open{{0, 0}};
  while (!open.empty()) {
    const auto [i, j] = open.front();
    open.pop_front();
    const Pose2 here(from.x() + kCell_m * i, from.y() + kCell_m * j, 0.0);
    if (distance(here, to) < kCell_m) return true;
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const std::pair<int, int> next{i + di, j + dj};
      const Pose2 pose(from.x() + kCell_m * next.first, from.y() + kCell_m * next.second, 0.0);
      if (!checker.collides(footprint, pose) && seen.insert(next).second) open.push_back(next);
    }
  }
  return false;
}

class GenerateRoom : public testing::Test {
 protected:
  const Catalog catalog_ = Catalog::standard();
};

TEST_F(GenerateRoom, isAFunctionOfItsOptions) {
  const std::string once = worldYaml(generateRoom(catalog_, roomFor("office_chair", 7)));
  EXPECT_EQ(worldYaml(generateRoom(catalog_, roomFor("office_chair", 7))), once);
  EXPECT_NE(worldYaml(generateRoom(catalog_, roomFor("office_chair", 8))), once);
}

TEST_F(GenerateRoom, isAsDenseAsAskedFor) {
  for (const double density : {0.0, 0.05, 0.15}) {
    const double reached = densityOf(generateRoom(catalog_, roomFor("office_chair", 3, density)));
    EXPECT_GE(reached, density - 1e-9);
    EXPECT_LT(reached, density + 0.02);
  }
}

class GuaranteedRooms : public testing::TestWithParam<std::string> {
 protected:
  void check(const WorldModel& room) const {
    const std::shared_ptr<const Map> map = surveyMap(room);
    CollisionChecker checker(*map);
    const auto disc = checker.footprint(spinning(object_));
    const Pose2 start = room.objects.front().map_T_object;
    EXPECT_FALSE(checker.collides(*disc, start));
    EXPECT_FALSE(checker.collides(*disc, *room.goal));
    EXPECT_TRUE(isConnected(checker, *disc, start, *room.goal));
    checker.setObstacles({{object_.solid, start, "object_1"}});
    EXPECT_FALSE(checker.collides(*checker.footprint(robot_.solid, 0.05), room.map_T_robot));
    // All around the object, and to where the last push ends.
    const RobotPathPlanner paths(robot_, RobotPathOptions{});
    const double reach_m = object_.radius_m + robot_.radius_m + 0.1;
    for (const Pose2& place : {start, *room.goal}) {
      for (const double bearing : {0.3, 1.9, 3.5, 5.1}) {
        const Eigen::Vector2d beside =
            place.position() + reach_m * Eigen::Vector2d(std::cos(bearing), std::sin(bearing));
        const Pose2 goal(beside.x(), beside.y(), bearing + M_PI);
        EXPECT_TRUE(paths.plan(checker, room.map_T_robot, goal, goal.yaw()).found)
            << "(" << beside.transpose() << ")";
      }
    }
  }

  const Catalog catalog_ = Catalog::standard();
  const ObjectModel object_ = catalog_.object(GetParam());
  const RobotModel robot_ = catalog_.robot("cobot");
};

TEST_P(GuaranteedRooms, startAndGoalAreFreeAndConnected) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    check(generateRoom(catalog_, roomFor(GetParam(), seed, 0.12)));
  }
}

TEST_P(GuaranteedRooms, comeBackFromAFileToTheLastBit) {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const WorldModel room = generateRoom(catalog_, roomFor(GetParam(), seed));
    saveWorldModel(room, folder.path() / "room.yaml");
    const WorldModel again = loadWorldModel(folder.path() / "room.yaml");
    EXPECT_EQ(again.map_T_robot.yaw(), room.map_T_robot.yaw());
    EXPECT_EQ(again.goal->position(), room.goal->position());
    EXPECT_EQ(again.goal->yaw(), room.goal->yaw());
    EXPECT_EQ(again.objects[0].map_T_object.yaw(), room.objects[0].map_T_object.yaw());
    ASSERT_EQ(again.boxes.size(), room.boxes.size());
    for (std::size_t i = 0; i < room.boxes.size(); ++i) {
      EXPECT_EQ(again.boxes[i].name, room.boxes[i].name);
      EXPECT_EQ(again.boxes[i].box.size_m, room.boxes[i].box.size_m);
      EXPECT_EQ(again.boxes[i].map_T_box.matrix(), room.boxes[i].map_T_box.matrix());
    }
    EXPECT_EQ(worldYaml(again), worldYaml(room));
  }
}

INSTANTIATE_TEST_SUITE_P(All, GuaranteedRooms, testing::ValuesIn(Catalog::standard().objectNames()),
                         [](const auto& object) { return object.param; });

TEST_F(GenerateRoom, putsMovableObjectsWhereTheyHitNothing) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RoomOptions options = roomFor("overbed_table", seed);
    options.movable = {"office_chair", "utility_cart", "office_chair"};
    const WorldModel world = generateRoom(catalog_, options);
    ASSERT_EQ(world.objects.size(), 4U);
    EXPECT_NO_THROW(Simulator(world, catalog_.robotOf(world), catalog_.objectsOf(world), {})) << seed;
  }
}

TEST_F(GenerateRoom, refusesWhatCannotBe) {
  const auto errorOf = [&](const RoomOptions& options) {
    return inputErrorText([&] { generateRoom(catalog_, options); });
  };
  EXPECT_EQ(errorOf(roomFor("office_chair", 1, -0.1, 1.0)),
            "room options: size is 1, must be in [2, 100]; density is -0.1, must be in [0, 0.5]");
  EXPECT_EQ(errorOf(roomFor("office_chair", 1, std::nan(""))),
            "room options: density is nan, must be in [0, 0.5]");
  EXPECT_EQ(errorOf(roomFor("stretcher", 1, 0.1, 5.0)),
            "room size: 5 m is too small for stretcher and cobot; must be at least 6 m");
  EXPECT_EQ(errorOf(roomFor("stretcher", 1, 0.0, 6.0)), "");
  const std::string dense = errorOf(roomFor("stretcher", 1, 0.4, 7.0));
  EXPECT_EQ(dense.rfind("room density: 0.4 does not fit: 0.", 0), 0U) << dense;
  EXPECT_NE(errorOf(roomFor("sofa", 1)).find("there is none named 'sofa'"), std::string::npos);
}

}  // namespace
}  // namespace casepush
