// What a load does to an object, by closed forms; and that putting it on disturbs nothing.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_conversions.h"
#include "casepush/common/input_error.h"
#include "contact_log.h"
#include "physics_world.h"
#include "sim/motions.h"
#include "sim/scenes.h"

namespace casepush::sim {
namespace {

constexpr double kCasterMass_kg = test::kForkMass_kg + test::kWheelMass_kg;

class LoadModels : public testing::TestWithParam<CasterModel> {
 protected:
  LoadModels() { options_.caster_model = GetParam(); }
  StepOptions options_;
};

INSTANTIATE_TEST_SUITE_P(Models, LoadModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

Load flatLoad(double mass_kg, double x_m = 0.0, double y_m = 0.0) {
  return {mass_kg, {x_m, y_m}, std::nullopt, {0.2, 0.1, 0.1}};
}

WorldModel worldWith(const Load& load) {
  WorldModel world = test::makeCartWorld();
  world.objects[0].load = load;
  return world;
}

Scene makeScene(const WorldModel& world, const test::CartOptions& cart = {}) {
  return Scene(world, test::makeRobot(), {{"cart", test::makeCart(cart)}});
}

void run(PhysicsWorld& physics, int steps) {
  ContactLog contacts;
  for (int i = 0; i < steps; ++i) physics.step(contacts);
}

TEST_P(LoadModels, addToThePushForceByWeight) {
  const double r = test::CartOptions().wheel_radius_m;
  for (const double load_kg : {0.0, 20.0, 80.0}) {
    WorldModel world = worldWith(flatLoad(load_kg));
    world.map_T_robot = Pose2(-0.56, 0.0, 0.0);
    const Scene scene = makeScene(world);
    WorldState state = restingState(scene);
    setRolling(state.furniture[0], 0.0, 0.0, r);
    PhysicsWorld physics(scene, state, options_);
    physics.setRobotTarget({0.3, 0.0, 0.0});
    run(physics, 240 * 2);
    ContactLog contacts;
    for (int i = 0; i < 240; ++i) physics.step(contacts);
    double force_n = 0.0;  // Over one second.
    for (const ContactReport& report : contacts.take()) force_n += report.impulse_ns;
    const double weight_n = (30.0 + 4.0 * kCasterMass_kg + load_kg) * kGravity_mps2;
    const double expected_n = world.floor.rolling_lever_arm_m * weight_n / r;
    EXPECT_NEAR(force_n, expected_n, 0.05 * expected_n) << load_kg << " kg";
  }
}

TEST_P(LoadModels, leaveTheCoastToTheWheelsInertia) {
  test::CartOptions cart;
  cart.swivels = false;
  const double r = cart.wheel_radius_m;
  const Scene scene = makeScene(worldWith(flatLoad(60.0)), cart);
  WorldState state = restingState(scene);
  setRolling(state.furniture[0], 0.5, 0.0, r);
  PhysicsWorld physics(scene, state, options_);
  run(physics, 240 * 4);
  const double mass_kg = cart.mass_kg + 4.0 * kCasterMass_kg + 60.0;
  const double moving_kg = mass_kg + 4.0 * test::wheelInertia(r) / (r * r);
  const double c_rr = scene.world.floor.rolling_lever_arm_m / r;
  const double expected_m = 0.25 / (2.0 * kGravity_mps2 * c_rr) * moving_kg / mass_kg;
  EXPECT_NEAR(physics.furniture(0).map_T_root().translation().x(), expected_m, 0.02 * expected_m);
}

// Of two carts that turn alike, the loaded one has the load's moment about the turning centre more.
TEST_P(LoadModels, addToYawInertiaByTheParallelAxisTheorem) {
  const Load load = flatLoad(20.0, 0.2, -0.1);
  const double own = 20.0 / 12.0 * (0.2 * 0.2 + 0.1 * 0.1);
  const double expected = own + 20.0 * (0.2 * 0.2 + 0.1 * 0.1);
  const double omega = 1.3;
  const auto energy = [&](const Load& carried, double omega_rps) {
    const Scene bare = makeScene(test::makeCartWorld());
    const Scene scene = makeScene(worldWith(carried));
    WorldState state = restingState(bare, 3);
    state.furniture[0].base_omega_rps = btVector3(0, 0, omega_rps);
    state.furniture[0] = carriedOver(state.furniture[0], bare.furniture[0], scene.furniture[0]);
    return PhysicsWorld(scene, state, options_).furniture(0).mechanicalEnergyJ();
  };
  const double bare_j = energy({}, omega) - energy({}, 0.0);
  const double loaded_j = energy(load, omega) - energy(load, 0.0);
  EXPECT_NEAR(2.0 * (loaded_j - bare_j) / (omega * omega), expected, 1e-9);
}

TEST_P(LoadModels, pressOnTheWheelsAsStaticsSay) {
  const test::CartOptions cart;
  const Scene scene = makeScene(worldWith(flatLoad(20.0, 0.1, -0.05)));
  WorldState state = restingState(scene);
  setRolling(state.furniture[0], 0.0, 0.0, cart.wheel_radius_m);
  PhysicsWorld physics(scene, state, options_);
  run(physics, 240);
  // Wheels at (+-0.22 - trail, +-0.15) share their moments alike, as springs do.
  const double total_kg = cart.mass_kg + 4.0 * kCasterMass_kg + 20.0;
  const double com_x =
      (20.0 * 0.1 - 4.0 * test::kWheelMass_kg * cart.trail_m) / total_kg + cart.trail_m;
  const double com_y = -20.0 * 0.05 / total_kg;
  const std::vector<double>& loads_n = physics.furniture(0).wheelLoadN();
  const double share_n = 0.25 * total_kg * kGravity_mps2;
  const double signs[4][2] = {{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  for (std::size_t i = 0; i < 4; ++i) {
    const double expected_n =
        share_n * (1.0 + signs[i][0] * com_x / 0.22 + signs[i][1] * com_y / 0.15);
    EXPECT_NEAR(loads_n[i], expected_n, 0.01 * share_n) << "wheel " << i;
  }
}

// A cart with fixed wheels 0.185 m in front of its origin tips about them.
test::CartOptions tippingCart() {
  test::CartOptions cart;
  cart.swivels = false;
  return cart;
}

double tippingLoadKg(double load_x_m) {
  const test::CartOptions cart = tippingCart();
  const double axle_m = 0.22 - cart.trail_m;
  const double wheels_kg = 4.0 * test::kWheelMass_kg;
  const double moment = cart.mass_kg * axle_m + 4.0 * test::kForkMass_kg * axle_m +
                        wheels_kg * (axle_m + cart.trail_m);
  return moment / (load_x_m - axle_m);
}

double pitchAfterASecond(double load_kg) {
  const Scene scene = makeScene(worldWith(flatLoad(load_kg, 0.29)), tippingCart());
  PhysicsWorld physics(scene, restingState(scene), {});
  run(physics, 240);
  return -std::asin(physics.furniture(0).map_T_root().linear()(2, 0)) * 180.0 / M_PI;
}

TEST(Loads, tipTheReferenceWhereTheirMomentSays) {
  const double limit_kg = tippingLoadKg(0.29);
  ASSERT_LT(limit_kg, 0.9 * kLargestLoad_kg);
  EXPECT_LT(std::abs(pitchAfterASecond(0.97 * limit_kg)), 0.5);
  EXPECT_GT(std::abs(pitchAfterASecond(1.03 * limit_kg)), 3.0);
}

TEST(Loads, thatWouldTipAreRefusedByThePlanarModel) {
  StepOptions planar;
  planar.caster_model = CasterModel::kPlanar;
  const double limit_kg = tippingLoadKg(0.29);
  const Scene stands = makeScene(worldWith(flatLoad(0.97 * limit_kg, 0.29)), tippingCart());
  EXPECT_NO_THROW(PhysicsWorld(stands, restingState(stands), planar));
  const Scene tips = makeScene(worldWith(flatLoad(75.0, 0.29)), tippingCart());
  try {
    PhysicsWorld(tips, restingState(tips), planar);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cart: the planar caster model needs three or more wheels or feet that bear load; "
                 "with 75 kg at (0.29, 0) m it would tip over");
  }
}

FurnitureState movingState(const Scene& scene) {
  FurnitureState state = restingState(scene, 5).furniture[0];
  state.base_velocity_mps = btVector3(0.4, -0.2, 0);
  state.base_omega_rps = btVector3(0, 0, 0.7);
  for (std::size_t i = 0; i < state.joint_rps.size(); ++i) state.joint_rps[i] = 1.0 + i;
  return state;
}

TEST_P(LoadModels, areTakenUpWithoutAJump) {
  const Load load = flatLoad(40.0, 0.15, 0.1);
  const Scene bare = makeScene(test::makeCartWorld());
  const Scene loaded = makeScene(worldWith(load));
  WorldState state = restingState(bare);
  state.furniture[0] = movingState(bare);
  PhysicsWorld physics(bare, state, options_);
  run(physics, 24);
  WorldState carried = physics.state();
  carried.furniture[0] = carriedOver(carried.furniture[0], bare.furniture[0], loaded.furniture[0]);
  const PhysicsWorld after(loaded, carried, options_);
  const Furniture& a = physics.furniture(0);
  const Furniture& b = after.furniture(0);
  EXPECT_NEAR(a.twist().vx_mps, b.twist().vx_mps, 1e-12);
  EXPECT_NEAR(a.twist().vy_mps, b.twist().vy_mps, 1e-12);
  EXPECT_NEAR(a.twist().wz_rps, b.twist().wz_rps, 1e-12);
  for (std::size_t i = 0; i < a.map_T_links().size(); ++i) {
    EXPECT_LT((a.map_T_links()[i].matrix() - b.map_T_links()[i].matrix()).norm(), 1e-9) << i;
  }
  // No energy but that of the load itself, at the velocity of its place.
  const Twist2 twist = a.twist();
  const Eigen::Vector2d velocity(twist.vx_mps - twist.wz_rps * 0.1,
                                 twist.vy_mps + twist.wz_rps * 0.15);
  const double height_m = loaded.furniture[0].load->height_m.value();
  const double expected_j = 20.0 * velocity.squaredNorm() +
                            0.5 * inertiaOf(load)(2, 2) * twist.wz_rps * twist.wz_rps +
                            40.0 * kGravity_mps2 * height_m;
  EXPECT_NEAR(b.mechanicalEnergyJ() - a.mechanicalEnergyJ(), expected_j, 1e-2 + 1e-9 * expected_j);
}

TEST_P(LoadModels, giveNoEnergyAfterwards) {
  const Scene bare = makeScene(test::makeCartWorld());
  const Scene loaded = makeScene(worldWith(flatLoad(40.0, 0.15, 0.1)));
  WorldState state = restingState(bare);
  state.furniture[0] = movingState(bare);
  state.furniture[0] = carriedOver(state.furniture[0], bare.furniture[0], loaded.furniture[0]);
  PhysicsWorld resting(loaded, restingState(loaded), options_);
  run(resting, 240);
  PhysicsWorld physics(loaded, state, options_);
  const double at_rest_j = resting.furniture(0).mechanicalEnergyJ();
  const double start_j = physics.furniture(0).mechanicalEnergyJ() - at_rest_j;
  double least_j = start_j;
  double gain_j = 0.0;
  for (int i = 0; i < 240 * 3; ++i) {
    run(physics, 1);
    const double energy_j = physics.furniture(0).mechanicalEnergyJ() - at_rest_j;
    gain_j = std::max(gain_j, energy_j - least_j);
    least_j = std::min(least_j, energy_j);
  }
  EXPECT_LT(gain_j, 1e-4 * start_j);
}

// A world that is built anew in the middle of a push goes on as if nothing had happened.
TEST_P(LoadModels, buildingAnewLeavesAPushAsItWas) {
  WorldModel world = worldWith(flatLoad(40.0));
  world.map_T_robot = Pose2(-0.7, 0.03, 0.0);
  const Scene scene = makeScene(world);
  PhysicsWorld whole(scene, restingState(scene, 2), options_);
  PhysicsWorld begun(scene, restingState(scene, 2), options_);
  whole.setRobotTarget({0.3, 0.0, 0.05});
  begun.setRobotTarget({0.3, 0.0, 0.05});
  run(whole, 240);
  run(begun, 240);
  PhysicsWorld again(scene, begun.state(), options_);
  again.setRobotTarget({0.3, 0.0, 0.05});
  for (int i = 0; i < 24; ++i) {
    run(whole, 1);
    run(again, 1);
    const Twist2 a = whole.furniture(0).twist();
    const Twist2 b = again.furniture(0).twist();
    EXPECT_NEAR(a.vx_mps, b.vx_mps, 0.01) << i;
    EXPECT_NEAR(a.wz_rps, b.wz_rps, 0.02) << i;
  }
  run(whole, 240);
  run(again, 240);
  EXPECT_LT(distance(toPlanar(whole.furniture(0).map_T_root()),
                     toPlanar(again.furniture(0).map_T_root())),
            0.002);
}

}  // namespace
}  // namespace casepush::sim
