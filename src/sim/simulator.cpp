#include "casepush/sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "bullet_conversions.h"
#include "casepush/common/input_error.h"
#include "contact_log.h"
#include "physics_world.h"
#include "scene.h"
#include "sensors.h"

namespace casepush {
namespace {

using sim::PhysicsWorld;
using sim::Scene;
using sim::WorldState;

constexpr char kRobotId[] = "robot";

std::vector<std::string> allBodies(const Scene& scene) {
  std::vector<std::string> bodies{kRobotId};
  for (const auto& furniture : scene.furniture) bodies.push_back(furniture.id);
  return bodies;
}

WorldState startState(const Scene& scene, Random& swivels) {
  WorldState state;
  state.robot = stateAtRest(scene.robot_blueprint, scene.world.map_T_robot);
  for (std::size_t i = 0; i < scene.furniture.size(); ++i) {
    state.furniture.push_back(
        stateAtRest(scene.furniture[i], scene.world.objects[i].map_T_object, swivels));
  }
  return state;
}

sim::StepOptions stepOptions(const SimulatorOptions& options) {
  return {options.step_s, options.solver_iterations, options.caster_model};
}

void checkPose(const WorldModel& world, const std::string& where, const Pose2& pose) {
  if (!pose.isFinite()) throw InputError(where, "the pose is not finite");
  if (world.contains(pose)) return;
  std::ostringstream what;
  what << "(" << pose.x() << ", " << pose.y() << ") is outside the world, which spans x "
       << world.min_m.x() << " to " << world.max_m.x() << ", y " << world.min_m.y() << " to "
       << world.max_m.y();
  throw InputError(where, what.str());
}

ObjectPlacement& placementOf(WorldModel& world, const std::string& id) {
  for (ObjectPlacement& object : world.objects) {
    if (object.id == id) return object;
  }
  throw InputError("simulator options: loads", world.where() + " holds no object \"" + id + "\"");
}

constexpr double kTolerance = 1.0 + 1e-9;  // A norm of limited components may exceed by rounding.

bool isTooFast(const RobotLimits& limits, const Twist2& twist) {
  return twist.speed() > limits.max_speed_mps * kTolerance;
}

bool turnsTooFast(const RobotLimits& limits, const Twist2& twist) {
  return std::abs(twist.wz_rps) > limits.max_yaw_rate_rps * kTolerance;
}

// Scales a twist into the limits; false if it was beyond them.
bool clampTwist(const RobotLimits& limits, Twist2& twist) {
  bool within = true;
  if (isTooFast(limits, twist)) {
    const double factor = limits.max_speed_mps / twist.speed();
    twist.vx_mps *= factor;
    twist.vy_mps *= factor;
    within = false;
  }
  if (turnsTooFast(limits, twist)) {
    twist.wz_rps = std::copysign(limits.max_yaw_rate_rps, twist.wz_rps);
    within = false;
  }
  return within;
}

}  // namespace

struct Simulator::Data {
  /// All that reset() replaces.
  struct Run {
    Run(const Scene& scene, const SimulatorOptions& options)
        : swivels(Random::stream(options.seed, "swivels")),
          physics(std::make_unique<PhysicsWorld>(scene, startState(scene, swivels),
                                                 stepOptions(options))),
          sensors(scene, options.sensor_noise, options.seed) {}

    Random swivels;
    std::unique_ptr<PhysicsWorld> physics;
    sim::Sensors sensors;
    sim::ContactLog contacts;
    std::int64_t steps = 0;
    Twist2 command;
    double command_time_s = -std::numeric_limits<double>::infinity();
  };

  Data(WorldModel world, RobotModel robot, std::map<std::string, ObjectModel> models,
       const SimulatorOptions& simulator_options)
      : scene(std::move(world), std::move(robot), std::move(models)), options(simulator_options) {
    start();
  }

  void start() {
    const std::vector<sim::FurnitureBlueprint> former = restoreLoads();  // Until the run is gone.
    auto next = std::make_unique<Run>(scene, options);
    const auto overlap = next->physics->findOverlap(allBodies(scene));
    if (overlap) throw InputError(scene.world.where(), *overlap);
    run = std::move(next);
  }

  std::vector<sim::FurnitureBlueprint> restoreLoads() {
    std::vector<sim::FurnitureBlueprint> former;
    for (const int object : changed_loads) {
      const auto& placement = scene.world.objects[static_cast<std::size_t>(object)];
      former.push_back(scene.setLoad(object, placement.load, placement.id));
    }
    changed_loads.clear();
    return former;
  }

  void setLoad(int object, const Load& load) {
    const auto i = static_cast<std::size_t>(object);
    WorldState state = run->physics->state();
    sim::FurnitureBlueprint former =
        scene.setLoad(object, load, "load on " + scene.furniture[i].id);
    state.furniture[i] = carriedOver(state.furniture[i], former, scene.furniture[i]);
    try {
      auto physics = std::make_unique<PhysicsWorld>(scene, state, stepOptions(options));
      run->contacts.forgetTags();  // They end with the former blueprint.
      run->physics = std::move(physics);
    } catch (const InputError&) {
      std::swap(scene.furniture[i], former);
      throw;
    }
    changed_loads.insert(object);
  }

  double time() const { return static_cast<double>(run->steps) * options.step_s; }

  int objectIndex(const std::string& id) const {
    const int index = scene.objectIndex(id);
    if (index < 0) {
      throw InputError("world " + scene.world.name, "there is no object \"" + id + "\"");
    }
    return index;
  }

  const sim::Furniture& furniture(const std::string& id) const {
    return run->physics->furniture(objectIndex(id));
  }

  Scene scene;
  SimulatorOptions options;
  std::set<int> changed_loads;  // Objects whose load may not be the world's any more.
  bool scanning = false;
  std::unique_ptr<Run> run;
};

Simulator::Simulator(WorldModel world, RobotModel robot, std::map<std::string, ObjectModel> models,
                     SimulatorOptions options) {
  options.validate();
  const std::string where = world.where() + ": ";
  checkPose(world, where + kRobotId, world.map_T_robot);
  for (const ObjectPlacement& object : world.objects) {
    checkPose(world, where + object.id, object.map_T_object);
  }
  for (const auto& [id, load] : options.loads) placementOf(world, id).load = load;
  data_ = std::make_unique<Data>(std::move(world), std::move(robot), std::move(models), options);
}

Simulator::~Simulator() = default;

bool Simulator::setCommand(const Twist2& robot_twist) {
  if (!robot_twist.isFinite()) return false;
  Twist2 twist = robot_twist;
  const bool within = clampTwist(data_->scene.robot.limits, twist);
  data_->run->command = twist;
  data_->run->command_time_s = time();
  return within;
}

std::string Simulator::commandFault(const Twist2& robot_twist) const {
  const RobotLimits& limits = data_->scene.robot.limits;
  std::ostringstream text;
  if (!robot_twist.isFinite()) {
    text << "(" << robot_twist.vx_mps << " m/s, " << robot_twist.vy_mps << " m/s, "
         << robot_twist.wz_rps << " rad/s) is not finite";
    return text.str();
  }
  if (isTooFast(limits, robot_twist)) {
    text << "the speed is " << robot_twist.speed() << " m/s, above the limit of "
         << limits.max_speed_mps << " m/s";
  }
  if (turnsTooFast(limits, robot_twist)) {
    text << (text.tellp() > 0 ? "; " : "") << "the yaw rate is " << robot_twist.wz_rps
         << " rad/s, beyond the limit of " << limits.max_yaw_rate_rps << " rad/s";
  }
  return text.str();
}

void Simulator::step(int count) {
  constexpr double kTimeEpsilon_s = 1e-9;
  Data::Run& run = *data_->run;
  for (int i = 0; i < count; ++i) {
    const double command_age_s = data_->time() - run.command_time_s;
    const bool expired = command_age_s > data_->options.command_timeout_s - kTimeEpsilon_s;
    run.physics->setRobotTarget(expired ? Twist2{} : run.command);
    run.physics->step(run.contacts);
    ++run.steps;
    run.sensors.update(data_->time(), data_->options.step_s, *run.physics, data_->scanning);
  }
}

double Simulator::time() const { return data_->time(); }
std::int64_t Simulator::stepCount() const { return data_->run->steps; }
double Simulator::stepSeconds() const { return data_->options.step_s; }

std::vector<TagFrame> Simulator::takeTagFrames() {
  return data_->run->sensors.cameras.take(time());
}

void Simulator::setScanning(bool wanted) { data_->scanning = wanted; }

std::vector<RangeScan> Simulator::takeScans() {
  return data_->run->sensors.range_sensors.take(time());
}

OdometryReading Simulator::odometry() const {
  return data_->run->sensors.localisation.reading(time());
}

std::vector<ContactReport> Simulator::takeContacts() { return data_->run->contacts.take(); }

Pose2 Simulator::trueRobotPose() const { return data_->run->physics->robot().pose(); }

Pose2 Simulator::trueObjectPose(const std::string& id) const {
  return sim::toPlanar(data_->furniture(id).map_T_root());
}

Twist2 Simulator::trueObjectTwist(const std::string& id) const {
  return data_->furniture(id).twist();
}

std::vector<Eigen::Isometry3d> Simulator::trueLinkPoses(const std::string& id) const {
  return data_->furniture(id).map_T_links();
}

void Simulator::setPose(const std::string& id, const Pose2& map_T_body) {
  setPoses({{id, map_T_body}});
}

void Simulator::setPoses(const std::map<std::string, Pose2>& map_T_bodies) {
  Data::Run& run = *data_->run;
  const Scene& scene = data_->scene;
  Random swivels = run.swivels;
  WorldState state = run.physics->state();
  std::vector<std::string> moved;
  for (const auto& [id, pose] : map_T_bodies) {
    moved.push_back(id);
    if (id == kRobotId) {
      checkPose(scene.world, id, pose);
      state.robot = stateAtRest(scene.robot_blueprint, pose);
      continue;
    }
    const auto index = static_cast<std::size_t>(data_->objectIndex(id));
    checkPose(scene.world, id, pose);
    state.furniture[index] = stateAtRest(scene.furniture[index], pose, swivels);
  }
  auto physics = std::make_unique<PhysicsWorld>(scene, state, stepOptions(data_->options));
  const auto overlap = physics->findOverlap(moved);
  if (overlap) throw InputError("world " + scene.world.name, *overlap);
  run.physics = std::move(physics);
  run.swivels = swivels;
  if (map_T_bodies.count(kRobotId) > 0) {
    run.command = {};
    run.sensors.localisation.relocate(trueRobotPose());
  }
}

void Simulator::setLoad(const std::string& id, const Load& load) {
  data_->setLoad(data_->objectIndex(id), load);
}

std::optional<Load> Simulator::load(const std::string& id) const {
  return data_->scene.furniture[static_cast<std::size_t>(data_->objectIndex(id))].load;
}

void Simulator::reset(std::uint64_t seed) {
  data_->options.seed = seed;
  data_->start();
}

const WorldModel& Simulator::world() const { return data_->scene.world; }
const RobotModel& Simulator::robot() const { return data_->scene.robot; }
const ObjectModel& Simulator::object(const std::string& id) const {
  return *data_->scene.furniture[static_cast<std::size_t>(data_->objectIndex(id))].model;
}

}  // namespace casepush
