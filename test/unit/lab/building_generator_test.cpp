#include "casepush/lab/building_generator.h"

#include <gtest/gtest.h>

#include "casepush/lab/push_run.h"
#include "casepush/planning/robot_path_planner.h"
#include "casepush/sim/simulator.h"
#include "common/input_error_text.h"

namespace casepush {
namespace {

WorldModel buildingOf(std::uint64_t seed) {
  BuildingOptions options;
  options.seed = seed;
  options.size_m = 20.0;
  return generateBuilding(Catalog::standard(), options);
}

TEST(GenerateBuilding, IsAFunctionOfItsOptions) {
  EXPECT_EQ(worldYaml(buildingOf(3)), worldYaml(buildingOf(3)));
  EXPECT_NE(worldYaml(buildingOf(3)), worldYaml(buildingOf(4)));
}

TEST(GenerateBuilding, NothingOverlapsAndTheRobotCanDriveFromCornerToCorner) {
  const Catalog catalog = Catalog::standard();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const WorldModel world = buildingOf(seed);
    EXPECT_NO_THROW(Simulator(world, catalog.robotOf(world), catalog.objectsOf(world), {})) << seed;
    const RobotPathPlanner paths(catalog.robotOf(world), {});
    const RobotPath path =
        paths.plan(CollisionChecker(*surveyMap(world)), world.map_T_robot, *world.goal, 0.0);
    EXPECT_TRUE(path.found) << seed << ": " << path.explanation;
    EXPECT_GT(path.length_m, 14.0);
  }
}

TEST(GenerateBuilding, RefusesRoomsThatAreTooSmall) {
  BuildingOptions options;
  options.room_m = 2.0;
  const std::string text = inputErrorText([&] { generateBuilding(Catalog::standard(), options); });
  EXPECT_NE(text.find("room"), std::string::npos) << text;
}

}  // namespace
}  // namespace casepush
