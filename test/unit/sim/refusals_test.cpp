// Bad input is refused when a world is put together, by file, element and reason.

#include <gtest/gtest.h>

#include "casepush/model/catalog.h"
#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "sim/driving.h"

namespace casepush {
namespace {

INSTANTIATE_TEST_SUITE_P(Models, SimulatorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

std::string errorOf(const WorldModel& world, const SimulatorOptions& options) {
  return inputErrorText([&] { makeSimulator(world, 1, options); });
}

TEST_P(SimulatorModels, refusesAnObjectInAWall) {
  WorldModel world = test::makeCartWorld();
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, 0.3, 0.0));
  EXPECT_EQ(errorOf(world, options()), "world test_floor: cart_1 (body) overlaps wall");
  world.objects[0].map_T_object = Pose2(-0.051, 0.0, 0.0);  // A millimetre away.
  EXPECT_EQ(errorOf(world, options()), "");
}

TEST_P(SimulatorModels, refusesAnObjectDeepInsideOfABlock) {
  WorldModel world = test::makeCartWorld();
  world.boxes.push_back(test::makeBox("block", {4.0, 4.0, 3.0}, 0.1, 0.2));
  world.map_T_robot = Pose2(-5.0, 0.0, 0.0);
  EXPECT_EQ(errorOf(world, options()), "world test_floor: cart_1 (body) overlaps block");
}

TEST_P(SimulatorModels, refusesTheRobotInAWallOrAnObject) {
  WorldModel world = test::makeCartWorld();
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, -2.2, 0.0));
  EXPECT_EQ(errorOf(world, options()), "world test_floor: robot (base) overlaps wall");
  world.boxes.clear();
  world.map_T_robot = Pose2(-0.5, 0.0, 0.0);
  const std::string text = errorOf(world, options());
  EXPECT_TRUE(text == "world test_floor: cart_1 (body) overlaps robot (base)" ||
              text == "world test_floor: robot (base) overlaps cart_1 (body)")
      << text;
}

TEST_P(SimulatorModels, refusesObjectsInEachOther) {
  WorldModel world = test::makeCartWorld();
  world.objects.push_back({"crate_1", "crate", Pose2(0.2, 0.2, 0.5), 0});
  const std::string text = errorOf(world, options());
  EXPECT_NE(text.find("cart_1 (body)"), std::string::npos) << text;
  EXPECT_NE(text.find("crate_1 (body)"), std::string::npos) << text;
  world.objects[1].map_T_object = world.objects[0].map_T_object;
  EXPECT_NE(errorOf(world, options()), "");
}

TEST_P(SimulatorModels, refusesWhatStandsOutside) {
  WorldModel world = test::makeCartWorld(Pose2(0.0, -10.1, 0.0));
  const std::string bounds = " is outside the world, which spans x -10 to 10, y -10 to 10";
  EXPECT_EQ(errorOf(world, options()), "world test_floor: cart_1: (0, -10.1)" + bounds);
  world.objects.clear();
  world.map_T_robot = Pose2(11.0, 0.0, 0.0);
  EXPECT_EQ(errorOf(world, options()), "world test_floor: robot: (11, 0)" + bounds);
}

TEST_P(SimulatorModels, refusesOddIds) {
  for (const char* id : {"", "cart 1", "/cart", "a\nb", "cart\x01"}) {
    WorldModel world = test::makeCartWorld();
    world.objects[0].id = id;
    const std::string text = errorOf(world, options());
    EXPECT_NE(text.find("is no good id"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

/// A world file in which the shipped chair stands, read as every tool reads it.
class RefusedFiles : public testing::Test {
 protected:
  std::string errorOf(const std::string& objects, const std::string& robot = "cobot",
                      const std::string& boxes = "[]") {
    const std::string yaml = "bounds: {min: [-5, -5], max: [5, 5]}\nrobot: {model: " + robot +
                             ", xy: [-3, 0], yaw_deg: 0}\nobjects: " + objects +
                             "\nboxes: " + boxes + "\n";
    file_ = folder_.write("room.yaml", yaml).string();
    return inputErrorText([&] {
      const Catalog catalog = Catalog::standard();
      const WorldModel world = catalog.world(file_);
      Simulator(world, catalog.robotOf(world), catalog.objectsOf(world), {});
    });
  }

  TemporaryFolder folder_;
  std::string file_;
};

constexpr char kChair[] = "{id: chair_1, model: office_chair, xy: [0, 0], yaw_deg: 0}";

TEST_F(RefusedFiles, nothingIsWrongWithTheFirst) {
  EXPECT_EQ(errorOf("[" + std::string(kChair) + "]"), "");
  EXPECT_EQ(errorOf("[]"), "");
}

TEST_F(RefusedFiles, nameFileAndBothThatOverlap) {
  const std::string second = "{id: chair_2, model: office_chair, xy: [0.1, 0], yaw_deg: 90}";
  const std::string text = errorOf("[" + std::string(kChair) + ", " + second + "]");
  EXPECT_EQ(text.rfind(file_ + ": chair_", 0), 0U) << text;
  EXPECT_NE(text.find("chair_1"), std::string::npos) << text;
  EXPECT_NE(text.find("chair_2"), std::string::npos) << text;
  const std::string wall = errorOf("[" + std::string(kChair) + "]", "cobot",
                                   "[{name: wall, size_m: [1, 1, 1], xyz: [0.2, 0, 0.5]}]");
  EXPECT_EQ(wall.rfind(file_ + ": chair_1 (", 0), 0U) << wall;
  EXPECT_NE(wall.find(") overlaps wall"), std::string::npos) << wall;
}

TEST_F(RefusedFiles, nameFileElementAndTheUnknownModel) {
  const std::string text = errorOf("[{id: p_1, model: piano, xy: [0, 0], yaw_deg: 0}]");
  EXPECT_EQ(
      text.rfind(file_ + ": object p_1: model: config/objects: there is none named 'piano'", 0), 0U)
      << text;
  const std::string robot = errorOf("[]", "r2d2");
  EXPECT_EQ(robot.rfind(file_ + ": robot: model: config/robots: there is none named 'r2d2'", 0), 0U)
      << robot;
}

TEST_F(RefusedFiles, nameTheUrdfAndItsElement) {
  const std::string urdf =
      folder_.write("bad.urdf", "<robot name=\"bad\"><link name=\"body\"/></robot>").string();
  folder_.write("bad.yaml", "class: bad\ntags: []\n");
  const std::string text = errorOf("[{id: bad_1, model: " + urdf + ", xy: [0, 0], yaw_deg: 0}]");
  EXPECT_EQ(text, file_ + ": object bad_1: model: " + urdf +
                      ": link 'body': has no inertia; every link needs an <inertial> element");
}

TEST_F(RefusedFiles, nameALoadThatIsNotOnTheObject) {
  const std::string text = errorOf(
      "[{id: chair_1, model: office_chair, xy: [0, 0], yaw_deg: 0, load: {mass_kg: 5, xy: [2, "
      "0]}}]");
  EXPECT_EQ(text.rfind(file_ + ": object chair_1: load: the place (2, 0) m", 0), 0U) << text;
}

TEST_F(RefusedFiles, nameObjectsOutsideOrWithOddIds) {
  const std::string outside =
      errorOf("[{id: chair_1, model: office_chair, xy: [0, 7], yaw_deg: 0}]");
  EXPECT_EQ(outside,
            file_ +
                ": objects[0].xy: (0, 7) is outside of the world; must be within (-5, -5) to "
                "(5, 5)");
  const std::string text = errorOf("[{id: chair 1, model: office_chair, xy: [0, 0], yaw_deg: 0}]");
  EXPECT_EQ(text.rfind(file_ + ": objects[0].id: 'chair 1' is no good id; must be", 0), 0U) << text;
}

}  // namespace
}  // namespace casepush
