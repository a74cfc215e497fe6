// Who touched whom, where, and how hard: every kind of pair, in both models of casters.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "sim/driving.h"

namespace casepush {
namespace {

INSTANTIATE_TEST_SUITE_P(Models, SimulatorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

/// A foot of 0.3 m that carries a bar of 0.5 m at the given height; its weight is low down.
ObjectModel makeBar(double low_m, double high_m) {
  ObjectModel model = test::makeCrate();
  Link& link = model.mechanism.links[0];
  link.mass_kg = 20.0;
  link.inertia_kgm2 = test::boxInertia(20.0, {0.3, 0.3, 0.1});
  link.link_T_inertial = test::at(0.0, 0.0, 0.05);
  link.collision.clear();
  link.collision.push_back({Box{{0.3, 0.3, 0.1}}, test::at(0.0, 0.0, 0.05), "body"});
  link.collision.push_back(
      {Box{{0.5, 0.5, high_m - low_m}}, test::at(0.0, 0.0, 0.5 * (low_m + high_m)), "body"});
  return model;
}

/// Base, basket and body one above the other, each a little farther out than the one below.
RobotModel makeTower() {
  RobotModel robot = test::makeRobot();
  robot.solid.clear();
  robot.solid.push_back({Box{{0.5, 0.5, 0.25}}, test::at(0.0, 0.0, 0.2), "base"});
  robot.solid.push_back({Box{{0.52, 0.4, 0.25}}, test::at(0.0, 0.0, 0.6), "basket"});
  robot.solid.push_back({Cylinder{0.2, 0.4}, test::at(0.0, 0.0, 1.0), "body"});
  return robot;
}

struct Height {
  const char* part;
  double low_m;
  double high_m;
};

TEST_P(SimulatorModels, nameThePartOfTheRobotThatTouches) {
  for (const Height& height :
       {Height{"base", 0.15, 0.3}, Height{"basket", 0.5, 0.7}, Height{"body", 0.85, 1.1}}) {
    WorldModel world = test::makeWorld();
    world.floor.friction = 0.1;  // The robot shall push it, not tip it.
    world.map_T_robot = Pose2(-0.6, 0.0, 0.0);
    world.objects.push_back({"bar_1", "bar", Pose2(), 0});
    Simulator simulator(world, makeTower(), {{"bar", makeBar(height.low_m, height.high_m)}},
                        options());
    drive(simulator, {0.2, 0.0, 0.0}, 2.0);
    const auto contacts = simulator.takeContacts();
    ASSERT_EQ(contacts.size(), 1u) << height.part;
    EXPECT_EQ(contacts[0].body_a, "bar_1");
    EXPECT_EQ(contacts[0].body_b, "robot");
    EXPECT_EQ(contacts[0].part_b, height.part);
    EXPECT_GT(contacts[0].impulse_ns, 1.0) << height.part;
    EXPECT_GT(contacts[0].map_point.z(), height.low_m - 0.02) << height.part;
    EXPECT_LT(contacts[0].map_point.z(), height.high_m + 0.02) << height.part;
  }
}

const ContactReport* find(const std::vector<ContactReport>& contacts, const std::string& a,
                          const std::string& b) {
  const auto found = std::find_if(contacts.begin(), contacts.end(), [&](const ContactReport& c) {
    return c.body_a == a && c.body_b == b;
  });
  return found == contacts.end() ? nullptr : &*found;
}

// Robot, cart, cart and wall in a row: what the drive gives goes through all of them.
TEST_P(SimulatorModels, passAForceOnFromRobotToObjectsToWall) {
  WorldModel world = test::makeCartWorld(Pose2(0.0, 0.0, 0.0));
  world.objects.push_back({"cart_2", "cart", Pose2(0.65, 0.0, 0.0), 10});
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, 1.05, 0.0));
  world.map_T_robot = Pose2(-0.6, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.3, 0.0, 0.0}, 3.0);
  simulator.takeContacts();
  drive(simulator, {0.3, 0.0, 0.0}, 1.0);
  const auto contacts = simulator.takeContacts();
  const ContactReport* robot = find(contacts, "cart_1", "robot");
  const ContactReport* between = find(contacts, "cart_1", "cart_2");
  const ContactReport* wall = find(contacts, "cart_2", "wall");
  ASSERT_TRUE(robot != nullptr && between != nullptr && wall != nullptr);
  EXPECT_EQ(contacts.size(), 3u);
  const double drive_ns = simulator.robot().limits.max_force_n;               // Over one second.
  const double rolling_ns = 34.0 * 9.81 * 0.0024 / 0.05 + 4.0 * 0.1 / 0.035;  // Of one cart.
  EXPECT_NEAR(robot->impulse_ns, drive_ns, 0.02 * drive_ns);
  EXPECT_NEAR(between->impulse_ns, robot->impulse_ns, rolling_ns);
  EXPECT_NEAR(wall->impulse_ns, between->impulse_ns, rolling_ns);
  EXPECT_NEAR(wall->map_point.x(), 1.0, 0.01);
  EXPECT_NEAR(between->map_point.x(), 0.4, 0.01);
  EXPECT_NEAR(robot->map_point.x(), -0.2, 0.01);
  EXPECT_LT(std::abs(robot->map_point.y()), 0.25);
}

TEST_P(SimulatorModels, reportTheRobotAgainstAWall) {
  WorldModel world = test::makeWorld();
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, 0.0, 1.0));
  world.map_T_robot = Pose2(-0.4, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.3, 0.0, 0.0}, 1.0);
  const auto contacts = simulator.takeContacts();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].body_b, "wall");
  EXPECT_EQ(contacts[0].part_b, "wall");
}

// What stops the robot is what the contact reports: m v.
TEST_P(SimulatorModels, sumUpToTheMomentumOfABlow) {
  WorldModel world = test::makeWorld();
  world.boxes.push_back(test::makeBox("wall", {0.1, 4.0, 1.0}, 0.0, 0.0));
  world.map_T_robot = Pose2(-0.8, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.5, 0.0, 0.0}, 0.6);
  double before_mps = 0.0;
  std::vector<ContactReport> contacts;
  for (int i = 0; i < 240 && contacts.empty(); ++i) {
    before_mps = simulator.odometry().robot_twist.vx_mps;
    simulator.setCommand({0.5, 0.0, 0.0});
    simulator.step();
    contacts = simulator.takeContacts();
  }
  ASSERT_EQ(contacts.size(), 1u);
  const double drive_ns = 150.0 / 240.0;
  const double lost_ns = 40.0 * (before_mps - simulator.odometry().robot_twist.vx_mps);
  EXPECT_GT(lost_ns, 1.0);
  EXPECT_NEAR(contacts[0].impulse_ns, lost_ns, drive_ns + 0.1);
}

TEST_P(SimulatorModels, areNoneInAWorldWithoutObjects) {
  Simulator simulator = makeSimulator(test::makeWorld(), 1, options());
  drive(simulator, {0.5, 0.2, 0.5}, 2.0);
  EXPECT_TRUE(simulator.takeContacts().empty());
  EXPECT_TRUE(simulator.world().objects.empty());
  simulator.reset(2);
  drive(simulator, {0.5, 0.2, 0.5}, 1.0);
  EXPECT_TRUE(simulator.takeContacts().empty());
}

TEST_P(SimulatorModels, ofThirtyObjectsComeOnceForEachPairInOrder) {
  WorldModel world = test::makeWorld();
  for (int i = 0; i < 30; ++i) {
    const std::string id = (i < 10 ? "cart_0" : "cart_") + std::to_string(i);
    world.objects.push_back({id, "cart", Pose2(0.62 * (i % 6), 0.42 * (i / 6) - 0.8, 0.0), i});
  }
  world.map_T_robot = Pose2(-0.8, 0.0, 0.0);
  Simulator simulator = makeSimulator(world, 1, options());
  drive(simulator, {0.5, 0.0, 0.1}, 3.0);
  const auto contacts = simulator.takeContacts();
  EXPECT_GT(contacts.size(), 8u);
  std::set<std::string> bodies;
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const ContactReport& contact : contacts) {
    bodies.insert(contact.body_a);
    bodies.insert(contact.body_b);
    pairs.emplace_back(contact.body_a, contact.body_b);
    EXPECT_LT(contact.body_a, contact.body_b);
    EXPECT_GT(contact.impulse_ns, 0.0);
    EXPECT_TRUE(contact.map_point.allFinite());
  }
  EXPECT_GT(bodies.size(), 8u);
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace
}  // namespace casepush
