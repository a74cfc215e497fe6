#include "furniture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "contact_log.h"
#include "featherstone_engine.h"
#include "physics_world.h"
#include "scene.h"
#include "sim/motions.h"
#include "sim/scenes.h"

namespace casepush::sim {
namespace {

StepOptions withModel(CasterModel model) {
  StepOptions options;
  options.caster_model = model;
  return options;
}

std::string modelName(const testing::TestParamInfo<CasterModel>& info) {
  return toString(info.param);
}

// Every model of casters has to obey the same laws.
class FurnitureModels : public testing::TestWithParam<CasterModel> {
 protected:
  const StepOptions options_ = withModel(GetParam());
};

INSTANTIATE_TEST_SUITE_P(Models, FurnitureModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         modelName);

double coastDistance(const test::CartOptions& cart, double lever_arm_m, double speed_mps,
                     const StepOptions& options) {
  WorldModel world = test::makeCartWorld();
  world.floor.rolling_lever_arm_m = lever_arm_m;
  const Scene scene(world, test::makeRobot(), {{"cart", test::makeCart(cart)}});
  WorldState state = restingState(scene);
  setRolling(state.furniture[0], speed_mps, 0.0, cart.wheel_radius_m);
  PhysicsWorld physics(scene, state, options);
  ContactLog contacts;
  for (int i = 0; i < 240 * 20; ++i) {
    physics.step(contacts);
    if (physics.furniture(0).twist().speed() < 1e-6) break;
  }
  return physics.furniture(0).map_T_root().translation().x();
}

struct CoastCase {
  CasterModel model;
  double lever_arm_m;
  bool swivels;
};

class FurnitureCoast : public testing::TestWithParam<CoastCase> {};

TEST_P(FurnitureCoast, stopsWhereRollingResistanceSays) {
  test::CartOptions cart;
  cart.swivels = GetParam().swivels;
  const double r = cart.wheel_radius_m;
  const double mass = cart.mass_kg + 4.0 * (test::kForkMass_kg + test::kWheelMass_kg);
  const double effective_mass = mass + 4.0 * test::wheelInertia(r) / (r * r);
  const double c_rr = GetParam().lever_arm_m / r;
  const double expected = 0.5 * 0.5 / (2.0 * kGravity_mps2 * c_rr) * effective_mass / mass;
  const double measured =
      coastDistance(cart, GetParam().lever_arm_m, 0.5, withModel(GetParam().model));
  EXPECT_NEAR(measured, expected, 0.02 * expected);
}

std::vector<CoastCase> coastCases() {
  std::vector<CoastCase> cases;
  for (const CasterModel model : {CasterModel::kFeatherstone, CasterModel::kPlanar}) {
    for (const double lever_arm_m : {0.0005, 0.001, 0.0024}) {
      cases.push_back({model, lever_arm_m, true});
    }
    cases.push_back({model, 0.001, false});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Floors, FurnitureCoast, testing::ValuesIn(coastCases()));

TEST_P(FurnitureModels, neverGainsEnergyWhileCoasting) {
  const Scene scene(test::makeCartWorld(), test::makeRobot(), {{"cart", test::makeCart()}});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    WorldState state = restingState(scene, seed);
    state.furniture[0].base_velocity_mps = btVector3(0.5, 0.1, 0);
    state.furniture[0].base_omega_rps = btVector3(0, 0, 0.8);
    PhysicsWorld physics(scene, state, options_);
    PhysicsWorld resting(scene, restingState(scene, seed), options_);
    const double at_rest = resting.furniture(0).mechanicalEnergyJ();
    const double at_start = physics.furniture(0).mechanicalEnergyJ() - at_rest;
    double least = at_start;
    double gain = 0.0;
    ContactLog contacts;
    for (int i = 0; i < 240 * 4; ++i) {
      physics.step(contacts);
      const double energy = physics.furniture(0).mechanicalEnergyJ() - at_rest;
      gain = std::max(gain, energy - least);
      least = std::min(least, energy);
    }
    EXPECT_LT(gain, 1e-4 * at_start) << "seed " << seed;
    EXPECT_LT(least, 0.05 * at_start) << "seed " << seed;
  }
}

// Points that a wheel has left behind would bear part of its load behind the axle, and drive it.
TEST(FeatherstoneEngine, letsARollingWheelTouchTheFloorInOnePoint) {
  const Scene scene(test::makeCartWorld(), test::makeRobot(), {{"cart", test::makeCart()}});
  for (const double speed_mps : {0.1, 0.3, 1.0}) {
    WorldState state = restingState(scene);
    setRolling(state.furniture[0], speed_mps, 0.0, 0.05);
    CollisionSpace space(scene);
    FeatherstoneEngine engine(scene, space, state, {});
    ContactLog contacts;
    for (int i = 0; i < 60; ++i) engine.step(contacts);
    int wheels = 0;
    for (int m = 0; m < space.dispatcher().getNumManifolds(); ++m) {
      const btPersistentManifold& manifold = *space.dispatcher().getManifoldByIndexInternal(m);
      if (tagOf(manifold.getBody0()).wheel < 0 && tagOf(manifold.getBody1()).wheel < 0) continue;
      EXPECT_EQ(manifold.getNumContacts(), 1) << speed_mps << " m/s";
      ++wheels;
    }
    EXPECT_EQ(wheels, 4);
  }
}

TEST_P(FurnitureModels, resistsASteadyPushByLoadAndLeverArm) {
  for (const double mass_kg : {10.0, 30.0, 60.0}) {
    test::CartOptions options;
    options.mass_kg = mass_kg;
    WorldModel world = test::makeCartWorld();
    world.map_T_robot = Pose2(-0.56, 0.0, 0.0);
    const Scene scene(world, test::makeRobot(), {{"cart", test::makeCart(options)}});
    WorldState state = restingState(scene);
    setRolling(state.furniture[0], 0.0, 0.0, options.wheel_radius_m);
    PhysicsWorld physics(scene, state, options_);
    physics.setRobotTarget({0.3, 0.0, 0.0});
    ContactLog contacts;
    for (int i = 0; i < 240 * 2; ++i) physics.step(contacts);
    contacts.take();
    for (int i = 0; i < 240; ++i) physics.step(contacts);
    double force_n = 0.0;  // Over one second.
    for (const ContactReport& report : contacts.take()) force_n += report.impulse_ns;
    const double weight_n = scene.furniture[0].mass_kg * kGravity_mps2;
    const double expected = world.floor.rolling_lever_arm_m * weight_n / options.wheel_radius_m;
    EXPECT_NEAR(force_n, expected, 0.1 * expected) << mass_kg << " kg";
  }
}

// On ice, only the bumper moves the cart: across by friction times what it moves it along.
TEST_P(FurnitureModels, rubsAsSurfacesSay) {
  WorldModel world = test::makeCartWorld();
  world.floor.friction = 0.0;
  world.floor.rolling_lever_arm_m = 0.0;
  world.map_T_robot = Pose2(-0.551, 0.0, 0.0);
  for (const double coefficient : {0.0, 0.4, 0.9}) {
    ObjectModel cart = test::makeCart();
    RobotModel robot = test::makeRobot();
    cart.surface_friction = coefficient;
    robot.surface_friction = 0.5;
    const Scene scene(world, robot, {{"cart", cart}});
    WorldState state = restingState(scene);
    setRolling(state.furniture[0], 0.0, 0.0, 0.05);
    PhysicsWorld physics(scene, state, options_);
    physics.setRobotTarget({20.0, 20.0, 0.0});  // Full force, along and across.
    ContactLog contacts;
    for (int i = 0; i < 60; ++i) physics.step(contacts);
    const btVector3 moved = physics.furniture(0).state().base_velocity_mps;
    EXPECT_GT(moved.x(), 0.3);
    EXPECT_NEAR(moved.y() / moved.x(), 0.5 * coefficient, 0.02) << coefficient;
  }
}

TEST_P(FurnitureModels, castersTrailAfterAStraightPush) {
  WorldModel world = test::makeCartWorld();
  world.map_T_robot = Pose2(-0.56, 0.0, 0.0);
  const Scene scene(world, test::makeRobot(), {{"cart", test::makeCart()}});
  WorldState state = restingState(scene);
  const double initial_deg[] = {30.0, -20.0, 40.0, -35.0};
  setRolling(state.furniture[0], 0.0, 0.0, 0.05);
  for (std::size_t i = 0; i < 4; ++i) {
    state.furniture[0].joint_rad[2 * i] = initial_deg[i] * M_PI / 180.0;
  }
  PhysicsWorld physics(scene, state, options_);
  physics.setRobotTarget({0.4, 0.0, 0.0});
  ContactLog contacts;
  while (physics.furniture(0).map_T_root().translation().x() < 0.8) physics.step(contacts);
  // Trailing means along the caster's own path, which is straight up to the cart's last turning.
  const double yaw_rps = physics.furniture(0).twist().wz_rps;
  EXPECT_NEAR(yaw_rps, 0.0, 0.01);
  const FurnitureState end = physics.furniture(0).state();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(end.joint_rad[2 * i] * 180.0 / M_PI, 0.0, 0.5) << "caster " << i;
  }
}

TEST_P(FurnitureModels, slidesAsCoulombFrictionSays) {
  WorldModel world = test::makeWorld();
  world.floor.friction = 0.4;
  world.objects.push_back({"crate_1", "crate", Pose2(), 0});
  const Scene scene(world, test::makeRobot(), {{"crate", test::makeCrate()}});
  WorldState state = restingState(scene);
  PhysicsWorld settled(scene, state, options_);
  state.furniture[0].base_velocity_mps = btVector3(1.0, 0, 0);
  PhysicsWorld physics(scene, state, options_);
  ContactLog contacts;
  for (int i = 0; i < 240; ++i) physics.step(contacts);
  const double expected = 1.0 / (2.0 * 0.4 * kGravity_mps2);
  EXPECT_NEAR(physics.furniture(0).map_T_root().translation().x(), expected, 0.03 * expected);
  EXPECT_LT(physics.furniture(0).twist().speed(), 1e-3);
}

TEST_P(FurnitureModels, wheelLoadsCarryTheWeight) {
  const Scene scene(test::makeCartWorld(), test::makeRobot(), {{"cart", test::makeCart()}});
  PhysicsWorld physics(scene, restingState(scene), options_);
  ContactLog contacts;
  for (int i = 0; i < 240; ++i) physics.step(contacts);
  double sum_n = 0.0;
  for (const double load_n : physics.furniture(0).wheelLoadN()) {
    EXPECT_GT(load_n, 0.0);
    sum_n += load_n;
  }
  const double weight_n = scene.furniture[0].mass_kg * kGravity_mps2;
  EXPECT_NEAR(sum_n, weight_n, 1e-3 * weight_n);
}

TEST_P(FurnitureModels, standsStillUntouched) {
  const Scene scene(test::makeCartWorld(), test::makeRobot(), {{"cart", test::makeCart()}});
  PhysicsWorld physics(scene, restingState(scene), options_);
  ContactLog contacts;
  for (int i = 0; i < 240 * 5; ++i) physics.step(contacts);
  const Eigen::Isometry3d map_T_root = physics.furniture(0).map_T_root();
  EXPECT_LT(map_T_root.translation().norm(), 1e-4);
  EXPECT_TRUE(contacts.take().empty());
}

TEST_P(FurnitureModels, linkPosesFollowTheJoints) {
  const ObjectModel cart = test::makeCart();
  const Scene scene(test::makeCartWorld(Pose2(1.0, 2.0, 0.5)), test::makeRobot(), {{"cart", cart}});
  WorldState state = restingState(scene);
  setRolling(state.furniture[0], 0.0, 0.7, 0.05);
  const PhysicsWorld physics(scene, state, options_);
  const auto poses = physics.furniture(0).map_T_links();
  ASSERT_EQ(poses.size(), cart.mechanism.links.size());
  const Eigen::Isometry3d map_T_root =
      test::at(1.0, 2.0, 0.0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  EXPECT_LT((poses[0].matrix() - map_T_root.matrix()).norm(), 1e-12);
  const Eigen::Isometry3d expected_wheel = map_T_root * test::at(0.22, 0.15, 0.12) *
                                           Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                                           test::at(-0.035, 0.0, -0.07);
  EXPECT_LT((poses[2].matrix() - expected_wheel.matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace casepush::sim
