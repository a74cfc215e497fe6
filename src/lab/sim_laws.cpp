#include "casepush/lab/sim_laws.h"

#include <cmath>
#include <set>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr char kCartId[] = "cart";
constexpr char kCartName[] = "utility_cart";
constexpr double kGravity_mps2 = 9.81;
constexpr double kGap_m = 0.005;
constexpr double kSpeed_mps = 0.3;
constexpr double kFaceDepth_m = 0.3;
constexpr double kRest_mps = 1e-4;
constexpr double kPushEachStep = 3600.0;  // No command expires.

std::set<std::size_t> casterLinks(const ObjectModel& cart) {
  std::set<std::size_t> links;
  for (const Caster& caster : cart.casters) {
    links.insert(static_cast<std::size_t>(caster.swivel_joint) + 1);
    links.insert(static_cast<std::size_t>(caster.wheel_joint) + 1);
  }
  return links;
}

void setMass(double mass_kg, ObjectModel& model) {
  const std::set<std::size_t> casters = casterLinks(model);
  double caster_mass_kg = 0.0;
  for (const std::size_t i : casters) caster_mass_kg += model.mechanism.links[i].mass_kg;
  const double empty_kg = model.mechanism.massKg() - caster_mass_kg;
  CASEPUSH_CHECK(mass_kg > caster_mass_kg, "casters alone weigh " << caster_mass_kg << " kg");
  const double factor = (mass_kg - caster_mass_kg) / empty_kg;
  for (std::size_t i = 0; i < model.mechanism.links.size(); ++i) {
    if (casters.count(i) > 0) continue;
    model.mechanism.links[i].mass_kg *= factor;
    model.mechanism.links[i].inertia_kgm2 *= factor;
  }
}

void setWheelRadius(double radius_m, ObjectModel& model) {
  for (Caster& caster : model.casters) {
    const auto joint = static_cast<std::size_t>(caster.wheel_joint);
    const double factor = radius_m / caster.wheel_radius_m;
    model.mechanism.joints[joint].parent_T_joint.translation().z() +=
        radius_m - caster.wheel_radius_m;
    model.mechanism.links[joint + 1].inertia_kgm2 *= factor * factor;
    caster.wheel_radius_m = radius_m;
  }
}

ObjectModel makeCart(const Catalog& catalog, const LawCart& cart) {
  ObjectModel model = catalog.object(kCartName);
  setMass(cart.mass_kg, model);
  setWheelRadius(cart.wheel_radius_m, model);
  return model;
}

/// A robot with a wide face in front, which pushes a flat side squarely.
RobotModel makePusher(const Catalog& catalog) {
  RobotModel robot = catalog.robot("cobot");
  robot.cameras.clear();
  PlacedShape face{Box{{kFaceDepth_m, 0.7, 0.4}}, Eigen::Isometry3d::Identity(), "face"};
  face.frame_T_shape.translation().z() = 0.3;
  robot.solid = {face};
  robot.radius_m = 0.4;
  return robot;
}

/// Cart and robot on an empty floor, and what they do in turn.
class Experiment {
 public:
  Experiment(const Catalog& catalog, const LawCart& cart, SimulatorOptions options)
      : simulator_(makeWorld(cart), makePusher(catalog), {{kCartName, makeCart(catalog, cart)}},
                   prepare(options)) {}

  Pose2 cart() const { return simulator_.trueObjectPose(kCartId); }
  Twist2 twist() const { return simulator_.trueObjectTwist(kCartId); }
  double time() const { return simulator_.time(); }
  void command(double speed_mps) { simulator_.setCommand({speed_mps, 0.0, 0.0}); }

  void runFor(double duration_s) {
    simulator_.step(static_cast<int>(std::lround(duration_s / simulator_.stepSeconds())));
  }

  /// Robot behind the cart or, across, at its right side; it stands.
  void placeRobot(bool across) {
    const Box& top =
        std::get<Box>(simulator_.object(kCartId).mechanism.links[0].collision[0].shape);
    const double back_m =
        0.5 * (kFaceDepth_m + (across ? top.size_m.y() : top.size_m.x())) + kGap_m;
    simulator_.setPose("robot",
                       cart() * (across ? Pose2(0.0, -back_m, M_PI_2) : Pose2(-back_m, 0.0, 0.0)));
  }

  /// Pushes for so long that casters trail, and waits until all is at rest.
  void roll(bool across) {
    placeRobot(across);
    command(kSpeed_mps);
    runFor(4.0);
    command(0.0);
    do runFor(0.1);
    while (twist().speed() > kRest_mps);
  }

  /// Mean contact force over a while.
  double forceOver(double duration_s) {
    simulator_.takeContacts();
    const double start_s = time();
    runFor(duration_s);
    double impulse_ns = 0.0;
    for (const ContactReport& report : simulator_.takeContacts()) impulse_ns += report.impulse_ns;
    return impulse_ns / (time() - start_s);
  }

  TrailSample trail(const Pose2& start) const {
    TrailSample sample{distance(start, cart()), {}};
    const std::vector<Eigen::Isometry3d> links = simulator_.trueLinkPoses(kCartId);
    for (const Caster& caster : simulator_.object(kCartId).casters) {
      const auto& fork = links[static_cast<std::size_t>(caster.swivel_joint) + 1];
      sample.swivel_rad.push_back(wrapAngle(std::atan2(fork(1, 0), fork(0, 0)) - cart().yaw()));
    }
    return sample;
  }

 private:
  static SimulatorOptions prepare(SimulatorOptions options) {
    options.sensor_noise = false;
    options.command_timeout_s = kPushEachStep;
    return options;
  }

  static WorldModel makeWorld(const LawCart& cart) {
    WorldModel world;
    world.name = "law";
    world.min_m = {-15.0, -15.0};
    world.max_m = {15.0, 15.0};
    world.floor.rolling_lever_arm_m = cart.rolling_lever_arm_m;
    world.map_T_robot = Pose2(-3.0, 0.0, 0.0);
    world.objects.push_back({kCartId, kCartName, Pose2(), 0});
    return world;
  }

  Simulator simulator_;
};

}  // namespace

double LawCart::weightN() const { return mass_kg * kGravity_mps2; }

double LawCart::rollingResistanceN() const {
  return rolling_lever_arm_m * weightN() / wheel_radius_m;
}

double measureSteadyForce(const Catalog& catalog, const LawCart& cart,
                          const SimulatorOptions& options) {
  Experiment experiment(catalog, cart, options);
  experiment.placeRobot(false);
  experiment.command(kSpeed_mps);
  experiment.runFor(5.0);
  return experiment.forceOver(1.0);
}

std::vector<ForceSample> measureStart(const Catalog& catalog, const LawCart& cart, bool across,
                                      const SimulatorOptions& options) {
  constexpr double kRamp_mps2 = 0.02;
  constexpr double kTick_s = 0.1;
  constexpr double kWay_m = 0.2;
  Experiment experiment(catalog, cart, options);
  experiment.roll(across);
  experiment.placeRobot(false);
  const Pose2 start = experiment.cart();
  const double start_s = experiment.time();
  std::vector<ForceSample> samples;
  while (samples.empty() || samples.back().moved_m < kWay_m) {
    experiment.command(kRamp_mps2 * (experiment.time() - start_s + kTick_s));
    const double force_n = experiment.forceOver(kTick_s);
    samples.push_back({distance(start, experiment.cart()), force_n});
  }
  return samples;
}

std::vector<CoastSample> measureCoast(const Catalog& catalog, const LawCart& cart,
                                      const SimulatorOptions& options) {
  constexpr double kTick_s = 0.05;
  Experiment experiment(catalog, cart, options);
  experiment.placeRobot(false);
  experiment.command(kSpeed_mps);
  experiment.runFor(5.0);
  experiment.command(0.0);
  while (experiment.forceOver(kTick_s) > 0.0) continue;
  const Pose2 start = experiment.cart();
  const double start_s = experiment.time();
  std::vector<CoastSample> samples{{0.0, 0.0, experiment.twist().speed()}};
  while (samples.back().speed_mps > kRest_mps) {
    experiment.runFor(kTick_s);
    samples.push_back({experiment.time() - start_s, distance(start, experiment.cart()),
                       experiment.twist().speed()});
  }
  return samples;
}

double coastDistance(const Catalog& catalog, const LawCart& cart, double speed_mps) {
  const ObjectModel model = makeCart(catalog, cart);
  double mass_kg = cart.mass_kg;
  for (const Caster& caster : model.casters) {
    const auto wheel = static_cast<std::size_t>(caster.wheel_joint) + 1;
    const Eigen::Vector3d& axle = model.mechanism.joints[wheel - 1].axis;
    mass_kg += axle.dot(model.mechanism.links[wheel].inertia_kgm2 * axle) /
               (caster.wheel_radius_m * caster.wheel_radius_m);
  }
  return 0.5 * mass_kg * speed_mps * speed_mps / cart.rollingResistanceN();
}

std::vector<TrailSample> measureTrailing(const Catalog& catalog, const LawCart& cart,
                                         const SimulatorOptions& options) {
  constexpr double kTick_s = 0.05;
  constexpr double kWay_m = 0.85;
  Experiment experiment(catalog, cart, options);
  experiment.placeRobot(false);
  const Pose2 start = experiment.cart();
  std::vector<TrailSample> samples{experiment.trail(start)};
  experiment.command(kSpeed_mps);
  while (samples.back().moved_m < kWay_m) {
    experiment.runFor(kTick_s);
    samples.push_back(experiment.trail(start));
  }
  return samples;
}

}  // namespace casepush
