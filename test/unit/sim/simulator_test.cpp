#include "casepush/sim/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/model/catalog.h"
#include "sim/driving.h"
#include "sim/scenes.h"

namespace casepush {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Touches, loses and re-places things, so that every cache of the engine gets its chance.
std::uint64_t exercise(Simulator& simulator) {
  drive(simulator, {0.4, 0.0, 0.1}, 5.0);
  simulator.setPoses({{"robot", Pose2(0.0, -3.0, M_PI_2)}, {"cart_1", Pose2(0.2, -1.5, 0.7)}});
  drive(simulator, {0.5, 0.05, 0.0}, 4.0);
  simulator.setPose("cart_1", Pose2(4.0, 4.0, -2.0));
  drive(simulator, {0.1, 0.0, -0.3}, 1.0);
  return hashOf(simulator);
}

INSTANTIATE_TEST_SUITE_P(Models, SimulatorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

TEST_P(SimulatorModels, repeatsItselfBitByBit) {
  Simulator first = makeSimulator(test::makeCartWorld(), 7, options());
  Simulator second = makeSimulator(test::makeCartWorld(), 7, options());
  const std::uint64_t hash = exercise(first);
  EXPECT_EQ(exercise(second), hash);
  second.step(100);
  second.reset(7);
  EXPECT_EQ(second.time(), 0.0);
  EXPECT_EQ(exercise(second), hash);
  second.reset(8);
  EXPECT_NE(exercise(second), hash);
}

TEST(Simulator, drawsSwivelsFromTheSeedAndAnewAtEachSetPose) {
  const auto swivelOf = [](const Simulator& simulator) {
    const Eigen::Isometry3d fork = simulator.trueLinkPoses("cart_1")[1];
    return std::atan2(fork(1, 0), fork(0, 0));
  };
  Simulator simulator = makeSimulator(test::makeCartWorld(), 1);
  const double first = swivelOf(simulator);
  simulator.reset(2);
  EXPECT_GT(std::abs(swivelOf(simulator) - first), 1e-3);
  simulator.reset(1);
  EXPECT_EQ(swivelOf(simulator), first);
  simulator.setPose("cart_1", Pose2());
  EXPECT_GT(std::abs(swivelOf(simulator) - first), 1e-3);
}

TEST_P(SimulatorModels, robotReachesTheCommandedVelocityAndStopsWithinAFifthOfASecond) {
  Simulator simulator = makeSimulator(test::makeWorld(), 1, options());
  drive(simulator, {0.4, 0.3, 0.0}, 0.5);
  const Twist2 moving = simulator.odometry().robot_twist;
  EXPECT_NEAR(moving.vx_mps, 0.4, 0.01);
  EXPECT_NEAR(moving.vy_mps, 0.3, 0.01);
  drive(simulator, {0.0, 0.0, 1.0}, 0.5);
  EXPECT_NEAR(simulator.odometry().robot_twist.wz_rps, 1.0, 0.02);
  drive(simulator, {0.5, 0.0, 0.0}, 0.5);
  simulator.setCommand({});
  simulator.step(48);
  EXPECT_LT(simulator.odometry().robot_twist.speed(), 1e-6);
  EXPECT_LT(std::abs(simulator.odometry().robot_twist.wz_rps), 1e-6);
}

TEST_P(SimulatorModels, pushesAWallWithNoMoreThanTheDriveGives) {
  WorldModel world = test::makeWorld();
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, 0.0, 0.0));
  world.map_T_robot = Pose2(-0.31, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.5, 0.0, 0.0}, 0.5);
  simulator.takeContacts();
  drive(simulator, {0.5, 0.0, 0.0}, 1.0);
  double force_n = 0.0;  // Over one second.
  for (const ContactReport& contact : simulator.takeContacts()) {
    EXPECT_EQ(contact.body_a, "robot");
    EXPECT_EQ(contact.part_a, "base");
    EXPECT_EQ(contact.body_b, "wall");
    force_n += contact.impulse_ns;
  }
  const double limit_n = simulator.robot().limits.max_force_n;
  EXPECT_NEAR(force_n, limit_n, 0.01 * limit_n);
  EXPECT_LT(simulator.trueRobotPose().x(), -0.29);
}

TEST_P(SimulatorModels, contactsNameParts) {
  WorldModel world = test::makeCartWorld(Pose2(0.0, 0.0, 0.0));
  world.map_T_robot = Pose2(-0.6, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  EXPECT_TRUE(simulator.takeContacts().empty());
  drive(simulator, {0.3, 0.0, 0.0}, 1.0);
  const auto contacts = simulator.takeContacts();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].body_a, "cart_1");
  EXPECT_EQ(contacts[0].part_a, "body");
  EXPECT_EQ(contacts[0].body_b, "robot");
  EXPECT_EQ(contacts[0].part_b, "base");
  EXPECT_GT(contacts[0].impulse_ns, 0.0);
  EXPECT_TRUE(simulator.takeContacts().empty());
}

TEST_P(SimulatorModels, refusesBadPosesAndStaysAsItWas) {
  WorldModel world = test::makeCartWorld();
  world.objects.push_back({"crate_1", "crate", Pose2(2.0, 2.0, 0.0), 0});
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, 5.0, 0.0));
  Simulator reference = makeSimulator(world, 1, options());
  Simulator simulator = makeSimulator(world, 1, options());
  drive(reference, {0.4, 0.0, 0.0}, 1.0);
  drive(simulator, {0.4, 0.0, 0.0}, 1.0);
  const auto set = [&](const std::map<std::string, Pose2>& poses) {
    return [&simulator, poses] { simulator.setPoses(poses); };
  };
  expectInputError(set({{"cart_1", Pose2(4.8, 0.0, 0.0)}}), "cart_1 (body) overlaps wall");
  expectInputError(set({{"cart_1", Pose2(2.1, 2.0, 0.0)}}), "overlaps");
  expectInputError(set({{"robot", Pose2(2.1, 2.0, 0.0)}}), "overlaps");
  expectInputError(set({{"crate_1", Pose2(1.0, 1.0, 0.0)}, {"cart_1", Pose2(0.0, 99.0, 0.0)}}),
                   "cart_1: (0, 99) is outside the world, which spans x -10 to 10, y -10 to 10");
  expectInputError(set({{"robot", Pose2(kNan, 0.0, 0.0)}}), "robot: the pose is not finite");
  expectInputError(set({{"sofa", Pose2()}}), "there is no object \"sofa\"");
  drive(reference, {0.4, 0.0, 0.2}, 3.0);
  drive(simulator, {0.4, 0.0, 0.2}, 3.0);
  EXPECT_EQ(hashOf(simulator), hashOf(reference));
  // The next random swivels must be the same, too.
  reference.setPose("cart_1", Pose2(-4.0, 2.0, 1.0));
  simulator.setPose("cart_1", Pose2(-4.0, 2.0, 1.0));
  drive(reference, {0.4, 0.0, 0.2}, 1.0);
  drive(simulator, {0.4, 0.0, 0.2}, 1.0);
  EXPECT_EQ(hashOf(simulator), hashOf(reference));
}

TEST_P(SimulatorModels, bodiesMayTradePlaces) {
  WorldModel world = test::makeCartWorld(Pose2(1.0, 1.0, 0.3));
  world.objects.push_back({"cart_2", "cart", Pose2(2.0, 2.0, 0.0), 10});
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.2, 0.0, 0.0}, 0.5);
  const double time_s = simulator.time();
  simulator.setPoses({{"cart_1", Pose2(2.0, 2.0, 0.0)}, {"cart_2", Pose2(1.0, 1.0, 0.3)}});
  EXPECT_EQ(simulator.time(), time_s);
  EXPECT_NEAR(simulator.trueObjectPose("cart_1").x(), 2.0, 1e-9);
  EXPECT_NEAR(simulator.trueObjectPose("cart_2").yaw(), 0.3, 1e-9);
  EXPECT_NEAR(simulator.odometry().robot_twist.vx_mps, 0.2, 0.01);  // Not moved: drives on.
}

TEST_P(SimulatorModels, refusesOverlappingStartPosesAndNamesBoth) {
  WorldModel world = test::makeCartWorld();
  world.map_T_robot = Pose2(-0.4, 0.0, 0.0);
  expectInputError([&] { makeSimulator(world, 1, options()); }, "world test_floor: ");
  expectInputError([&] { makeSimulator(world, 1, options()); }, "cart_1 (body)");
  expectInputError([&] { makeSimulator(world, 1, options()); }, "robot (base)");
}

TEST(Simulator, refusesUnusableWorlds) {
  WorldModel twice = test::makeCartWorld();
  twice.objects.push_back({"cart_1", "cart", Pose2(3.0, 0.0, 0.0), 0});
  expectInputError([&] { makeSimulator(twice); }, "object cart_1: its id is taken");
  WorldModel unknown = test::makeWorld();
  unknown.objects.push_back({"sofa_1", "sofa", Pose2(), 0});
  expectInputError([&] { makeSimulator(unknown); }, "object sofa_1: its model sofa was not given");
  WorldModel outside = test::makeCartWorld(Pose2(11.0, 0.0, 0.0));
  expectInputError([&] { makeSimulator(outside); }, "cart_1: (11, 0) is outside the world");
  SimulatorOptions options;
  options.step_s = 0.0;
  options.solver_iterations = -3;
  expectInputError([&] { makeSimulator(test::makeWorld(), 1, options); },
                   "simulator options: step_s is 0, must be in [1e-05, 0.02]; solver_iterations "
                   "is -3, must be in [1, 10000]");
}

TEST(Simulator, agreesWithAnEightTimesFinerStep) {
  SimulatorOptions fine;
  fine.step_s = 1.0 / 1920.0;
  fine.solver_iterations = 40;
  std::vector<double> differences_m;
  for (std::uint64_t seed = 1; seed <= 7; ++seed) {
    WorldModel world = test::makeCartWorld();
    Random random(seed);
    const double offset_m = random.uniform(-0.08, 0.08);
    world.objects[0].map_T_object = Pose2(0.0, 0.0, random.uniform(-M_PI, M_PI));
    world.map_T_robot = Pose2(-0.8, offset_m, 0.0);
    const Twist2 twist{random.uniform(0.3, 0.5), 0.0, random.uniform(-0.15, 0.15)};
    Simulator coarse_simulator = makeSimulator(world, seed);
    Simulator fine_simulator = makeSimulator(world, seed, fine);
    for (Simulator* simulator : {&coarse_simulator, &fine_simulator}) {
      drive(*simulator, twist, 3.0);
      drive(*simulator, {}, 1.0);
    }
    const Pose2 coarse_pose = coarse_simulator.trueObjectPose("cart_1");
    EXPECT_GT(coarse_pose.position().norm(), 0.2);
    differences_m.push_back(distance(coarse_pose, fine_simulator.trueObjectPose("cart_1")));
  }
  std::sort(differences_m.begin(), differences_m.end());
  EXPECT_LT(differences_m[differences_m.size() / 2], 0.015);
}

// The shipped chair in the shipped room, by what the files say.
TEST(Simulator, shippedChairStandsStillAndNamesWhatTouchesIt) {
  const Catalog catalog = Catalog::standard();
  const WorldModel world = catalog.world("open_floor");
  const RobotModel robot = catalog.robot(world.robot);
  const ObjectPlacement& chair = world.objects.at(0);
  Simulator simulator(world, robot, {{chair.model, catalog.object(chair.model)}}, {});
  simulator.step(480);
  EXPECT_LT(distance(simulator.trueObjectPose(chair.id), chair.map_T_object), 1e-4);
  EXPECT_LT(std::abs(simulator.trueLinkPoses(chair.id)[0].translation().z()), 1e-3);
  EXPECT_TRUE(simulator.takeContacts().empty());
  const Pose2 behind = chair.map_T_object * Pose2(-0.7, 0.0, 0.0);
  simulator.setPose("robot", behind);
  drive(simulator, {0.4, 0.0, 0.0}, 2.0);
  EXPECT_GT(simulator.trueObjectPose(chair.id).x() - chair.map_T_object.x(), 0.3);
  const auto contacts = simulator.takeContacts();
  ASSERT_FALSE(contacts.empty());
  for (const ContactReport& contact : contacts) {
    EXPECT_EQ(contact.body_a, chair.id);
    EXPECT_GE(simulator.object(chair.id).mechanism.linkIndex(contact.part_a), 0) << contact.part_a;
    EXPECT_EQ(contact.body_b, "robot");
    EXPECT_GE(robot.mechanism.linkIndex(contact.part_b), 0) << contact.part_b;
  }
}

}  // namespace
}  // namespace casepush
