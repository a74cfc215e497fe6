#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/lab/sim_benchmark.h"

namespace casepush {
namespace {

constexpr char kObjectId[] = "object";
constexpr double kFloorHalfM = 12.0;
constexpr double kCommandPeriodS = 0.05;
constexpr double kRestLimitS = 20.0;
constexpr double kRestSpeed = 1e-3;  // m/s and rad/s
constexpr double kGapM = 0.02;
constexpr double kDurationsPerS = 60.0;

struct RandomPush {
  double object_yaw_rad = 0.0;
  double offset_m = 0.0;  // Of the object's origin from the robot's line of travel.
  Twist2 robot_twist;
  double duration_s = 0.0;
};

RandomPush drawPush(Random& random, double object_radius_m) {
  RandomPush push;
  push.object_yaw_rad = random.uniform(-M_PI, M_PI);
  push.offset_m = random.uniform(-0.5, 0.5) * object_radius_m;
  push.robot_twist.vx_mps = random.uniform(0.15, 0.4);
  push.robot_twist.wz_rps = random.uniform(-0.3, 0.3);
  // In whole steps of every simulator, or rounding would look like physics.
  push.duration_s = std::round(random.uniform(1.0, 3.0) * kDurationsPerS) / kDurationsPerS;
  return push;
}

WorldModel emptyFloor(const std::string& object, const std::string& robot, const RandomPush& push) {
  WorldModel world;
  world.name = "benchmark";
  world.min_m = {-kFloorHalfM, -kFloorHalfM};
  world.max_m = {kFloorHalfM, kFloorHalfM};
  world.robot = robot;
  world.map_T_robot = Pose2(-5.0, 0.0, 0.0);
  world.objects.push_back({kObjectId, object, Pose2(0.0, push.offset_m, push.object_yaw_rad), 0});
  return world;
}

// Moves the robot along its line of travel up to the object.
void placeRobot(WorldModel& world, const RobotModel& robot, const ObjectModel& object,
                const SimulatorOptions& options) {
  Simulator probe(world, robot, {{object.name, object}}, options);
  double clear_x = -robot.radius_m - object.radius_m - 0.1;
  double blocked_x = 0.0;
  while (blocked_x - clear_x > 0.002) {
    const double x = 0.5 * (clear_x + blocked_x);
    try {
      probe.setPose("robot", Pose2(x, 0.0, 0.0));
      clear_x = x;
    } catch (const InputError&) {
      blocked_x = x;
    }
  }
  world.map_T_robot = Pose2(clear_x - kGapM, 0.0, 0.0);
}

void runFor(Simulator& simulator, const Twist2& twist, double duration_s) {
  const double end_s = simulator.time() + duration_s - 0.5 * simulator.stepSeconds();
  double command_s = simulator.time();
  while (simulator.time() < end_s) {
    if (simulator.time() >= command_s) {
      simulator.setCommand(twist);
      command_s += kCommandPeriodS;
    }
    simulator.step();
  }
}

double tiltOf(const Simulator& simulator) {
  const Eigen::Isometry3d map_T_root = simulator.trueLinkPoses(kObjectId).front();
  return std::atan2(std::hypot(map_T_root(0, 2), map_T_root(1, 2)), map_T_root(2, 2));
}

// Where the object comes to rest, in its start frame; yaw counts whole turns.
Eigen::Vector3d outcomeOf(Simulator& simulator, const RandomPush& push, double& tilt_rad) {
  const Pose2 start = simulator.trueObjectPose(kObjectId);
  Pose2 last = start;
  double turned_rad = 0.0;
  const auto run = [&](const Twist2& twist, double duration_s) {
    runFor(simulator, twist, duration_s);
    const Pose2 now = simulator.trueObjectPose(kObjectId);
    turned_rad += yawDifference(last, now);
    last = now;
    tilt_rad = std::max(tilt_rad, tiltOf(simulator));
  };
  constexpr double kLookPeriodS = 0.1;
  for (double t = 0.0; t < push.duration_s; t += kLookPeriodS) {
    run(push.robot_twist, std::min(kLookPeriodS, push.duration_s - t));
  }
  for (double t = 0.0; t < kRestLimitS; t += kLookPeriodS) {
    run({}, kLookPeriodS);
    const Twist2 twist = simulator.trueObjectTwist(kObjectId);
    if (twist.speed() < kRestSpeed && std::abs(twist.wz_rps) < kRestSpeed) break;
  }
  const Pose2 end = start.inverse() * last;
  return {end.x(), end.y(), turned_rad};
}

class Comparison {
 public:
  Comparison(const Catalog& catalog, const OutcomeComparisonOptions& options)
      : options_(options),
        robot_(catalog.robot(options.robot)),
        object_(catalog.object(options.object)) {
    robot_.cameras.clear();  // Nobody looks.
    options_.reference.sensor_noise = false;
    for (SimulatorOptions& other : options_.others) other.sensor_noise = false;
  }

  PushOutcomes compare(int number) const {
    Random random = Random::stream(options_.seed, "push " + std::to_string(number));
    const RandomPush push = drawPush(random, object_.radius_m);
    WorldModel world = emptyFloor(object_.name, options_.robot, push);
    placeRobot(world, robot_, object_, options_.reference);
    std::vector<std::uint64_t> seeds;
    for (int i = 0; i < options_.swivels; ++i) seeds.push_back(random.bits());
    PushOutcomes result;
    result.reference = outcomesOf(world, push, seeds, options_.reference, result.tilt_rad);
    double tilt_rad = 0.0;
    for (const SimulatorOptions& other : options_.others) {
      result.others.push_back(outcomesOf(world, push, seeds, other, tilt_rad));
    }
    return result;
  }

 private:
  Outcomes outcomesOf(const WorldModel& world, const RandomPush& push,
                      const std::vector<std::uint64_t>& seeds, const SimulatorOptions& options,
                      double& tilt_rad) const {
    Simulator simulator(world, robot_, {{object_.name, object_}}, options);
    Outcomes outcomes;
    for (const std::uint64_t seed : seeds) {
      simulator.reset(seed);
      outcomes.push_back(outcomeOf(simulator, push, tilt_rad));
    }
    return outcomes;
  }

  OutcomeComparisonOptions options_;
  RobotModel robot_;
  ObjectModel object_;
};

}  // namespace

OutcomeMoments momentsOf(const Outcomes& outcomes) {
  const double n = static_cast<double>(outcomes.size());
  OutcomeMoments result;
  for (const Eigen::Vector3d& outcome : outcomes) result.mean += outcome / n;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& outcome : outcomes) {
    variance += (outcome - result.mean).cwiseAbs2() / (n - 1.0);
  }
  result.position_sigma_m = std::sqrt(variance.x() + variance.y());
  result.yaw_sigma_rad = std::sqrt(variance.z());
  return result;
}

void OutcomeComparisonOptions::validate() const {
  std::ostringstream text;
  const auto require = [&](const char* key, int value, int low, int high) {
    if (value >= low && value <= high) return;
    text << (text.tellp() > 0 ? "; " : "") << key << " is " << value << ", must be in [" << low
         << ", " << high << "]";
  };
  require("pushes", pushes, 1, 100000);
  require("swivels", swivels, 2, 100000);
  require("jobs", jobs, 1, 1024);
  if (!text.str().empty()) throw InputError("outcome comparison", text.str());
  reference.validate();
  for (const SimulatorOptions& other : others) other.validate();
}

std::vector<PushOutcomes> compareOutcomes(const Catalog& catalog,
                                          const OutcomeComparisonOptions& options,
                                          const std::function<void(int)>& progress) {
  options.validate();
  const Comparison comparison(catalog, options);
  std::vector<PushOutcomes> results(static_cast<std::size_t>(options.pushes));
  std::atomic<int> next{0};
  std::mutex mutex;
  int done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (int i = next++; i < options.pushes; i = next++) {
      try {
        results[static_cast<std::size_t>(i)] = comparison.compare(i);
        const std::lock_guard<std::mutex> lock(mutex);
        ++done;
        if (progress) progress(done);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        failure = std::current_exception();
        next = options.pushes;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < options.jobs; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace casepush
