#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bullet_conversions.h"
#include "casepush/common/input_error.h"
#include "casepush/model/catalog.h"
#include "contact_log.h"
#include "physics_world.h"
#include "scene.h"
#include "sim/motions.h"
#include "sim/scenes.h"
#include "wheel_loads.h"

namespace casepush::sim {
namespace {

StepOptions planar() {
  StepOptions options;
  options.caster_model = CasterModel::kPlanar;
  return options;
}

Pose2 outcome(const Scene& scene, const WorldState& state, const StepOptions& options,
              const Twist2& twist) {
  PhysicsWorld physics(scene, state, options);
  ContactLog contacts;
  for (int i = 0; i < 240 * 4; ++i) {
    physics.setRobotTarget(i < 240 * 2 ? twist : Twist2{});
    physics.step(contacts);
  }
  return toPlanar(physics.furniture(0).map_T_root());
}

// Single pushes may differ much where a caster turns to one side or the other, so most have to
// agree rather than all.
TEST(CasterModels, agreeOnMostPushes) {
  std::vector<double> differences_m;
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    Random random(seed);
    WorldModel world = test::makeCartWorld(Pose2(0.0, 0.0, random.uniform(-M_PI, M_PI)));
    world.map_T_robot = Pose2(-0.75, random.uniform(-0.1, 0.1), 0.0);
    const Scene scene(world, test::makeRobot(), {{"cart", test::makeCart()}});
    const Twist2 twist{random.uniform(0.25, 0.4), 0.0, random.uniform(-0.2, 0.2)};
    const WorldState state = restingState(scene, seed);
    const Pose2 reference = outcome(scene, state, {}, twist);
    EXPECT_GT(reference.position().norm(), 0.1);
    differences_m.push_back(distance(reference, outcome(scene, state, planar(), twist)));
  }
  std::sort(differences_m.begin(), differences_m.end());
  EXPECT_LT(differences_m[7], 0.01);
  EXPECT_LT(differences_m[12], 0.05);
}

TEST(CasterModels, shareTheLoadOfACartThatStands) {
  test::CartOptions options;
  const Scene scene(test::makeCartWorld(), test::makeRobot(), {{"cart", test::makeCart(options)}});
  std::vector<std::vector<double>> loads;
  for (const StepOptions& step : {StepOptions(), planar()}) {
    PhysicsWorld physics(scene, restingState(scene, 3), step);
    ContactLog contacts;
    for (int i = 0; i < 240; ++i) physics.step(contacts);
    loads.push_back(physics.furniture(0).wheelLoadN());
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(loads[0][i], loads[1][i], 2.0) << "wheel " << i;
}

// The same for every model and object: sum of loads and moments about the floor, and equal springs.
void expectStatics(const FurnitureBlueprint& blueprint, const Furniture& furniture,
                   const std::string& what) {
  const std::vector<Eigen::Isometry3d> links = furniture.map_T_links();
  const Mechanism& mechanism = blueprint.model->mechanism;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Eigen::Vector3d com = links[i] * mechanism.links[i].link_T_inertial.translation();
    moment += kGravity_mps2 * mechanism.links[i].mass_kg * com.head<2>();
  }
  std::vector<Eigen::Vector2d> points;
  for (const Caster& caster : blueprint.model->casters) {
    const auto wheel = static_cast<std::size_t>(caster.wheel_joint) + 1;
    points.emplace_back(links[wheel].translation().head<2>());
  }
  const double weight_n = blueprint.mass_kg * kGravity_mps2;
  std::vector<double> expected(points.size());
  ASSERT_TRUE(shareLoad(points, weight_n, moment, expected)) << what;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(furniture.wheelLoadN()[i], expected[i], 0.005 * weight_n) << what << ", " << i;
  }
}

TEST(CasterModels, bearLoadsAsStaticsSaysAtRest) {
  const Catalog catalog = Catalog::standard();
  for (const std::string& name : catalog.objectNames()) {
    const ObjectModel object = catalog.object(name);
    if (object.casters.empty()) continue;
    WorldModel world = test::makeWorld();
    world.objects.push_back({"object", name, Pose2(0.3, 0.2, 0.4), 0});
    const Scene scene(world, test::makeRobot(), {{name, object}});
    for (const StepOptions& step : {StepOptions(), planar()}) {
      PhysicsWorld physics(scene, restingState(scene, 3), step);
      ContactLog contacts;
      for (int i = 0; i < 240; ++i) physics.step(contacts);
      expectStatics(scene.furniture[0], physics.furniture(0),
                    name + ", " + toString(step.caster_model));
    }
  }
}

// Mean over half a second of a steady push.
std::vector<double> loadsUnderPush(const Scene& scene, const WorldState& state,
                                   const StepOptions& options) {
  constexpr int kMeanSteps = 120;
  PhysicsWorld physics(scene, state, options);
  physics.setRobotTarget({0.3, 0.0, 0.0});
  ContactLog contacts;
  for (int i = 0; i < 240 * 2; ++i) physics.step(contacts);
  std::vector<double> loads(physics.furniture(0).wheelLoadN().size(), 0.0);
  for (int i = 0; i < kMeanSteps; ++i) {
    physics.step(contacts);
    for (std::size_t k = 0; k < loads.size(); ++k) {
      loads[k] += physics.furniture(0).wheelLoadN()[k] / kMeanSteps;
    }
  }
  return loads;
}

// Pushed faces bear at their lowest points, and that shifts loads forwards. In the reference they also
// rub up and down, which adds some load.
TEST(CasterModels, shiftLoadsAlikeUnderAPush) {
  const Catalog catalog = Catalog::standard();
  for (const std::string& name : catalog.objectNames()) {
    const ObjectModel object = catalog.object(name);
    if (object.casters.empty()) continue;
    WorldModel world = test::makeWorld();
    world.map_T_robot = Pose2(-object.radius_m - 0.4, 0.0, 0.0);
    world.objects.push_back({"object", name, Pose2(), 0});
    const Scene scene(world, test::makeRobot(), {{name, object}});
    WorldState state = restingState(scene, 1);
    for (double& angle_rad : state.furniture[0].joint_rad) angle_rad = 0.0;  // Trailing.
    const std::vector<double> reference = loadsUnderPush(scene, state, {});
    const std::vector<double> other = loadsUnderPush(scene, state, planar());
    const double weight_n = scene.furniture[0].mass_kg * kGravity_mps2;
    EXPECT_NEAR(std::accumulate(reference.begin(), reference.end(), 0.0), weight_n,
                0.04 * weight_n);
    EXPECT_NEAR(std::accumulate(other.begin(), other.end(), 0.0), weight_n, 0.001 * weight_n);
    for (std::size_t i = 0; i < other.size(); ++i) {
      EXPECT_NEAR(reference[i], other[i], 0.04 * weight_n) << name << ", wheel " << i;
    }
  }
}

// Without friction in bearings and wheels nothing takes energy: wheels roll, and a swivel turns
// freely. The step loses a little, and must never add.
TEST(CasterModels, keepTheEnergyOfAFrictionlessCart) {
  test::CartOptions cart;
  cart.swivel_friction_nm = 0.0;
  WorldModel world = test::makeCartWorld();
  world.floor.rolling_lever_arm_m = 0.0;
  const Scene scene(world, test::makeRobot(), {{"cart", test::makeCart(cart)}});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    WorldState state = restingState(scene, seed);
    state.furniture[0].base_velocity_mps = btVector3(0.5, 0.1, 0);
    state.furniture[0].base_omega_rps = btVector3(0, 0, 0.5);
    PhysicsWorld physics(scene, state, planar());
    PhysicsWorld resting(scene, restingState(scene, seed), planar());
    ContactLog contacts;
    // At first wheels slip sideways: swivels stand at random.
    for (int i = 0; i < 240; ++i) physics.step(contacts);
    const double at_rest = resting.furniture(0).mechanicalEnergyJ();
    const double at_start = physics.furniture(0).mechanicalEnergyJ() - at_rest;
    double last = at_start;
    for (int i = 0; i < 240 * 2; ++i) {
      physics.step(contacts);
      const double energy = physics.furniture(0).mechanicalEnergyJ() - at_rest;
      EXPECT_LT(energy - last, 1e-6 * at_start) << "seed " << seed << ", step " << i;
      last = energy;
    }
    EXPECT_GT(last, 0.97 * at_start) << "seed " << seed;
  }
}

TEST(CasterModels, passOnEachOthersState) {
  const Scene scene(test::makeCartWorld(Pose2(0.4, -0.2, 0.3)), test::makeRobot(),
                    {{"cart", test::makeCart()}});
  WorldState state = restingState(scene, 4);
  state.furniture[0].base_velocity_mps = btVector3(0.5, 0.1, 0);
  state.furniture[0].base_omega_rps = btVector3(0, 0, 0.8);
  for (std::size_t i = 0; i < 8; ++i) state.furniture[0].joint_rps[i] = 0.1 * i;
  const PhysicsWorld physics(scene, state, planar());
  const FurnitureState copy = physics.state().furniture[0];
  EXPECT_LT((copy.map_T_base.getOrigin() - state.furniture[0].map_T_base.getOrigin()).length(),
            1e-12);
  EXPECT_LT((copy.base_velocity_mps - state.furniture[0].base_velocity_mps).length(), 1e-12);
  EXPECT_NEAR(copy.base_omega_rps.z(), 0.8, 1e-12);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(copy.joint_rad[i], state.furniture[0].joint_rad[i], 1e-12);
    EXPECT_NEAR(copy.joint_rps[i], state.furniture[0].joint_rps[i], 1e-12);
  }
  const PhysicsWorld reference(scene, state, {});
  const auto links = physics.furniture(0).map_T_links();
  const auto reference_links = reference.furniture(0).map_T_links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    EXPECT_LT((links[i].matrix() - reference_links[i].matrix()).norm(), 1e-9) << "link " << i;
  }
  const Twist2 twist = physics.furniture(0).twist();
  const Twist2 reference_twist = reference.furniture(0).twist();
  EXPECT_NEAR(twist.vx_mps, reference_twist.vx_mps, 1e-9);
  EXPECT_NEAR(twist.vy_mps, reference_twist.vy_mps, 1e-9);
}

TEST(CasterModels, planarRefusesWhatCannotStand) {
  ObjectModel bicycle = test::makeCart();
  bicycle.casters.resize(2);
  bicycle.mechanism.links.resize(5);
  bicycle.mechanism.joints.resize(4);
  const Scene scene(test::makeCartWorld(), test::makeRobot(), {{"cart", bicycle}});
  try {
    PhysicsWorld(scene, restingState(scene, 1), planar());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cart: the planar caster model needs three or more wheels or feet that bear load");
  }
}

TEST(CasterModels, haveNames) {
  EXPECT_EQ(casterModelFromString("planar"), CasterModel::kPlanar);
  EXPECT_EQ(casterModelFromString(toString(CasterModel::kFeatherstone)),
            CasterModel::kFeatherstone);
  EXPECT_THROW(casterModelFromString("flat"), InputError);
}

}  // namespace
}  // namespace casepush::sim
