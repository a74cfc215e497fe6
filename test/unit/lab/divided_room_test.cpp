#include "casepush/lab/divided_room.h"

#include <gtest/gtest.h>

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
bool hasRoom(const WorldModel& world, const Solid& solid, double from_m, double to_m) {
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
      if (!checker.collides(*footprint, Pose2(x, 5.0, k * M_PI / 24.0))) return true;
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

TEST(DividedRoom, ATooSmallOneIsRefused) {
  DividedRoomOptions options;
  options.size_m = 5.0;
  const std::string text =
      inputErrorText([&] { generateDividedRoom(Catalog::standard(), options); });
  EXPECT_NE(text.find("at least"), std::string::npos) << text;
}

}  // namespace
}  // namespace casepush
