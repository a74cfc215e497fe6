#include "casepush/lab/divided_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "casepush/lab/push_run.h"
#include "casepush/sim/simulator.h"
#include "common/input_error_text.h"

namespace casepush {
namespace {

WorldModel roomOf(std::uint64_t seed) {
  DividedRoomOptions options;
  options.seed = seed;
  return generateDividedRoom(Catalog::standard(), options);
}

TEST(DividedRoom, IsAFunctionOfItsOptions) {
  EXPECT_EQ(worldYaml(roomOf(3)), worldYaml(roomOf(3)));
  EXPECT_NE(worldYaml(roomOf(3)), worldYaml(roomOf(4)));
}

TEST(DividedRoom, NothingOverlaps) {
  const Catalog catalog = Catalog::standard();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const WorldModel world = roomOf(seed);
    EXPECT_NO_THROW(Simulator(world, catalog.robotOf(world), catalog.objectsOf(world), {})) << seed;
  }
}

TEST(DividedRoom, HasAnObjectOnEachSideAndTheOthersInTheDoor) {
  const WorldModel world = roomOf(5);
  ASSERT_EQ(world.objects.size(), 3U);
  EXPECT_LT(world.objects[0].map_T_object.y(), 4.0);
  EXPECT_GT(world.goal->y(), 6.0);
  for (int i : {1, 2}) EXPECT_NEAR(world.objects[i].map_T_object.y(), 5.0, 0.11);
}

/// Is there room for a solid at some heading, somewhere on this part of the dividing wall's line?
bool hasRoom(const WorldModel& world, const Solid& solid, double from_m, double to_m,
             double y_m = 5.0) {
  const Catalog catalog = Catalog::standard();
  CollisionChecker checker(*surveyMap(world));
  std::vector<PlacedSolid> standing;
  for (std::size_t i = 1; i < world.objects.size(); ++i) {
    standing.push_back(
        {catalog.object(world.objects[i].model).solid, world.objects[i].map_T_object});
  }
  checker.setObstacles(standing);
  const auto footprint = checker.footprint(solid);
  for (double x = from_m; x <= to_m; x += 0.05) {
    for (int k = 0; k < 24; ++k) {
      if (!checker.collides(*footprint, Pose2(x, y_m, k * M_PI / 24.0))) return true;
    }
  }
  return false;
}

TEST(DividedRoom, NoRobotCanFollowThroughTheNearDoorAndTheFarOneIsOpen) {
  const Catalog catalog = Catalog::standard();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const WorldModel world = roomOf(seed);
    EXPECT_FALSE(hasRoom(world, catalog.robot("cobot").solid, 0.2, 4.5)) << "seed " << seed;
    EXPECT_TRUE(hasRoom(world, catalog.object("overbed_table").solid, 5.5, 9.8)) << "seed " << seed;
  }
}

/// Of what stands in the near door.
double doorMiddle(const WorldModel& world) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < world.objects.size(); ++i) {
    sum_m += world.objects[i].map_T_object.x();
  }
  return sum_m / static_cast<double>(world.objects.size() - 1);
}

TEST(DividedRoom, HasTheMeasuresAskedFor) {
  DividedRoomOptions options;
  options.size_m = 13.0;
  options.depth_m = 7.0;
  options.doors_apart_m = 4.0;
  options.movable = {"office_chair"};
  const WorldModel world = generateDividedRoom(Catalog::standard(), options);
  EXPECT_EQ(world.max_m, Eigen::Vector2d(13.0, 7.0));
  const double near_m = world.objects[1].map_T_object.x();
  const Catalog catalog = Catalog::standard();
  EXPECT_TRUE(
      hasRoom(world, catalog.object("overbed_table").solid, near_m + 3.7, near_m + 4.3, 3.5));
  EXPECT_LT(std::abs(world.objects[0].map_T_object.x() - near_m), 0.6);
}

DividedRoomOptions drawn(std::uint64_t seed) {
  DividedRoomOptions options;
  options.seed = seed;
  return drawDividedRoom(Catalog::standard(), options);
}

TEST(DrawDividedRoom, DrawsRoomsInWhichNothingOverlapsAndTheFarDoorIsOpen) {
  const Catalog catalog = Catalog::standard();
  const Solid table = catalog.object("overbed_table").solid;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const DividedRoomOptions options = drawn(seed);
    const WorldModel world = generateDividedRoom(catalog, options);
    EXPECT_NO_THROW(Simulator(world, catalog.robotOf(world), catalog.objectsOf(world), {})) << seed;
    const double near_m = doorMiddle(world);
    const double far_m = near_m + *options.doors_apart_m;
    EXPECT_TRUE(hasRoom(world, table, far_m - 0.2, far_m + 0.2, 0.5 * world.max_m.y())) << seed;
  }
}

TEST(DrawDividedRoom, VariesMeasuresAndObstacles) {
  std::set<std::size_t> counts;
  std::set<std::string> kinds;
  double least_m = 100.0, most_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const DividedRoomOptions options = drawn(seed);
    counts.insert(options.movable.size());
    kinds.insert(options.movable.begin(), options.movable.end());
    least_m = std::min(least_m, *options.doors_apart_m);
    most_m = std::max(most_m, *options.doors_apart_m);
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{1, 2}));
  EXPECT_EQ(kinds.size(), 2U);
  EXPECT_LT(least_m, 4.0);
  EXPECT_GT(most_m, 8.0);
  EXPECT_EQ(drawn(7).doors_apart_m, drawn(7).doors_apart_m);
}

TEST(DrawDividedRoom, NeedsSomethingToStandInTheDoor) {
  DividedRoomOptions options;
  options.movable.clear();
  const std::string text = inputErrorText([&] { drawDividedRoom(Catalog::standard(), options); });
  EXPECT_NE(text.find("at least one"), std::string::npos) << text;
}

TEST(DividedRoom, DoorsThatMeetAreRefused) {
  DividedRoomOptions options;
  options.doors_apart_m = 1.0;
  const std::string text =
      inputErrorText([&] { generateDividedRoom(Catalog::standard(), options); });
  EXPECT_NE(text.find("distance of the doors"), std::string::npos) << text;
}

TEST(DividedRoom, ATooSmallOneIsRefused) {
  DividedRoomOptions options;
  options.size_m = 5.0;
  const std::string text =
      inputErrorText([&] { generateDividedRoom(Catalog::standard(), options); });
  EXPECT_NE(text.find("at least"), std::string::npos) << text;
}

}  // namespace
}  // namespace casepush
