// Loads as a caller of the simulator sees them.

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/model/catalog.h"
#include "sim/driving.h"

namespace casepush {
namespace {

INSTANTIATE_TEST_SUITE_P(Models, SimulatorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

/// How far the cart rolls on after a push that ends.
double coastAfterPush(Simulator& simulator) {
  drive(simulator, {0.5, 0.0, 0.0}, 3.0);
  const double x_m = simulator.trueObjectPose("cart_1").x();
  drive(simulator, {-0.2, 0.0, 0.0}, 4.0);
  return simulator.trueObjectPose("cart_1").x() - x_m;
}

TEST_P(SimulatorModels, takesLoadsAndGivesThemBack) {
  Simulator simulator = makeSimulator(test::makeCartWorld(), 1, options());
  EXPECT_FALSE(simulator.load("cart_1"));
  simulator.setLoad("cart_1", {40.0, {0.1, -0.1}});
  ASSERT_TRUE(simulator.load("cart_1"));
  EXPECT_EQ(simulator.load("cart_1")->mass_kg, 40.0);
  EXPECT_NEAR(*simulator.load("cart_1")->height_m, 0.62 + 0.1, 1e-12);
  simulator.setLoad("cart_1", {5.0});
  EXPECT_EQ(simulator.load("cart_1")->mass_kg, 5.0);
  simulator.setLoad("cart_1", {0.0});
  EXPECT_FALSE(simulator.load("cart_1"));
}

TEST_P(SimulatorModels, resetBringsBackTheLoadsOfTheStart) {
  WorldModel world = test::makeCartWorld();
  world.objects[0].load = Load{10.0};
  SimulatorOptions with = options();
  Simulator simulator = makeSimulator(world, 1, with);
  EXPECT_EQ(simulator.load("cart_1")->mass_kg, 10.0);
  simulator.setLoad("cart_1", {0.0});
  simulator.reset(1);
  EXPECT_EQ(simulator.load("cart_1")->mass_kg, 10.0);
  with.loads["cart_1"] = Load{20.0};
  Simulator other = makeSimulator(world, 1, with);
  EXPECT_EQ(other.load("cart_1")->mass_kg, 20.0);
  other.setLoad("cart_1", {50.0});
  other.reset(1);
  EXPECT_EQ(other.load("cart_1")->mass_kg, 20.0);
}

TEST_P(SimulatorModels, aLoadThatCameLaterIsLikeOneFromTheStart) {
  WorldModel world = test::makeCartWorld();
  Simulator later = makeSimulator(world, 1, options());
  later.setLoad("cart_1", {40.0, {0.05, 0.05}});
  world.objects[0].load = Load{40.0, {0.05, 0.05}};
  Simulator start = makeSimulator(world, 1, options());
  const double later_m = coastAfterPush(later);
  EXPECT_NEAR(later_m, coastAfterPush(start), 0.01 * later_m + 0.002);
}

TEST_P(SimulatorModels, motionGoesOnWhenALoadComes) {
  Simulator simulator = makeSimulator(test::makeCartWorld(), 1, options());
  drive(simulator, {0.5, 0.0, 0.05}, 4.0);
  const Twist2 before = simulator.trueObjectTwist("cart_1");
  const Pose2 pose = simulator.trueObjectPose("cart_1");
  const Twist2 robot = simulator.odometry().robot_twist;
  const std::int64_t steps = simulator.stepCount();
  ASSERT_GT(before.speed(), 0.3);
  simulator.setLoad("cart_1", {60.0, {0.1, 0.1}});
  const Twist2 after = simulator.trueObjectTwist("cart_1");
  EXPECT_EQ(simulator.stepCount(), steps);
  EXPECT_LT(distance(simulator.trueObjectPose("cart_1"), pose), 1e-12);
  EXPECT_NEAR(after.vx_mps, before.vx_mps, 1e-12);
  EXPECT_NEAR(after.vy_mps, before.vy_mps, 1e-12);
  EXPECT_NEAR(after.wz_rps, before.wz_rps, 1e-12);
  simulator.setCommand({0.5, 0.0, 0.05});
  simulator.step();
  EXPECT_NEAR(simulator.odometry().robot_twist.vx_mps, robot.vx_mps, 0.03);
  EXPECT_NEAR(simulator.trueObjectTwist("cart_1").vx_mps, before.vx_mps, 0.03);
}

TEST_P(SimulatorModels, contactsOfBeforeKeepTheirNames) {
  WorldModel world = test::makeCartWorld();
  world.map_T_robot = Pose2(-0.6, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.3, 0.0, 0.0}, 0.5);
  simulator.setLoad("cart_1", {40.0});
  drive(simulator, {0.3, 0.0, 0.0}, 0.5);
  const auto contacts = simulator.takeContacts();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].body_a, "cart_1");
  EXPECT_EQ(contacts[0].part_a, "body");
}

TEST_P(SimulatorModels, refusesLoadsThatCannotBeAndStaysAsItWas) {
  Simulator simulator = makeSimulator(test::makeCartWorld(), 1, options());
  Simulator reference = makeSimulator(test::makeCartWorld(), 1, options());
  drive(simulator, {0.4, 0.0, 0.0}, 2.0);
  drive(reference, {0.4, 0.0, 0.0}, 2.0);
  const auto refused = [&](const std::string& id, const Load& load, const std::string& text) {
    expectInputError([&] { simulator.setLoad(id, load); }, text);
  };
  refused("sofa", {1.0}, "there is no object \"sofa\"");
  refused("robot", {1.0}, "there is no object \"robot\"");
  refused("cart_1", {81.0}, "load on cart_1: the mass is 81 kg; must be in [0, 80] kg");
  refused("cart_1", {std::nan("")}, "load on cart_1: the mass is nan kg");
  refused("cart_1", {10.0, {0.4, 0.0}}, "load on cart_1: the place (0.4, 0) m");
  refused("cart_1", {10.0, {0.0, 0.0}, 3.0}, "the height of the centre is 3 m");
  drive(simulator, {0.4, 0.0, 0.2}, 1.0);
  drive(reference, {0.4, 0.0, 0.2}, 1.0);
  EXPECT_EQ(hashOf(simulator), hashOf(reference));
}

TEST(SetLoad, keepsAPlanarWorldAsItWasIfTheObjectWouldTip) {
  test::CartOptions cart;
  cart.swivels = false;
  cart.mass_kg = 5.0;
  SimulatorOptions planar;
  planar.caster_model = CasterModel::kPlanar;
  WorldModel world = test::makeCartWorld();
  world.map_T_robot = Pose2(-0.7, 0.0, 0.0);
  Simulator simulator(world, test::makeRobot(), {{"cart", test::makeCart(cart)}}, planar);
  simulator.setLoad("cart_1", {1.0});
  expectInputError(
      [&] {
        simulator.setLoad("cart_1", {80.0, {0.29, 0.0}});
      },
      "with 80 kg at (0.29, 0) m it would tip over");
  EXPECT_EQ(simulator.load("cart_1")->mass_kg, 1.0);
  drive(simulator, {0.4, 0.0, 0.0}, 3.0);
  EXPECT_GT(simulator.trueObjectPose("cart_1").x(), 0.1);
}

TEST(SetLoad, refusesBadLoadsAtTheStartAndNamesTheElement) {
  WorldModel world = test::makeCartWorld();
  world.objects[0].load = Load{10.0, {0.5, 0.0}};
  expectInputError([&] { makeSimulator(world); },
                   "world test_floor: object cart_1: load: the place (0.5, 0) m");
  SimulatorOptions options;
  options.loads["sofa"] = Load{10.0};
  expectInputError([&] { makeSimulator(test::makeCartWorld(), 1, options); },
                   "simulator options: loads: world test_floor holds no object \"sofa\"");
}

// What later experiments do: 40 kg on the overbed table, in both models.
TEST_P(SimulatorModels, anOverbedTableCarriesFortyKilograms) {
  const Catalog catalog = Catalog::standard();
  WorldModel world = catalog.world("open_floor");
  placeObject(world, catalog, "overbed_table");
  SimulatorOptions with = options();
  const std::string id = world.objects.at(0).id;
  with.loads[id] = Load{40.0, {0.0, 0.0}};
  Simulator simulator(world, catalog.robotOf(world), catalog.objectsOf(world), with);
  const Pose2 start = simulator.trueObjectPose(id);
  simulator.step(480);
  EXPECT_LT(distance(simulator.trueObjectPose(id), start), 1e-3);
  simulator.setPose("robot", start * Pose2(-0.85, 0.0, 0.0));
  drive(simulator, {0.3, 0.0, 0.0}, 4.0);
  EXPECT_GT(distance(simulator.trueObjectPose(id), start), 0.2);
  const Eigen::Vector3d up = simulator.trueLinkPoses(id)[0].linear().col(2);
  EXPECT_GT(up.z(), std::cos(2.0 * M_PI / 180.0));
}

}  // namespace
}  // namespace casepush
