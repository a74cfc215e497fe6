#include <cmath>

#include "casepush/lab/sim_benchmark.h"
#include "thread_time.h"

namespace casepush {
namespace {

constexpr int kObjects = 4;
constexpr double kHallHalfM = 10.0;
constexpr double kPushSpeedMps = 0.4;
constexpr double kRunS = 10.0;
constexpr int kRecreations = 200;

StaticBox boxAt(const std::string& name, const Eigen::Vector3d& size_m, double x, double y) {
  StaticBox box;
  box.name = name;
  box.box.size_m = size_m;
  box.map_T_box.translation() << x, y, 0.5 * size_m.z();
  return box;
}

// The robot before a row of objects that it will push all at once; or before the first one, with
// the others beside its way.
WorldModel hall(const ObjectModel& object, const RobotModel& robot, bool in_row) {
  WorldModel world;
  world.name = "hall";
  world.min_m = {-kHallHalfM, -kHallHalfM};
  world.max_m = {kHallHalfM, kHallHalfM};
  world.robot = robot.name;
  double x = -6.0;
  world.map_T_robot = Pose2(x, 0.0, 0.0);
  x += robot.radius_m + object.radius_m + 0.05;
  for (int i = 0; i < kObjects; ++i) {
    const double y = in_row || i == 0 ? 0.0 : 5.0;
    world.objects.push_back({"object_" + std::to_string(i), object.name, Pose2(x, y, 0.0), 0});
    x += 2.0 * object.radius_m + 0.02;
  }
  const double length_m = 2.0 * kHallHalfM;
  world.boxes.push_back(boxAt("wall_south", {length_m, 0.1, 1.5}, 0.0, -kHallHalfM));
  world.boxes.push_back(boxAt("wall_north", {length_m, 0.1, 1.5}, 0.0, kHallHalfM));
  world.boxes.push_back(boxAt("wall_west", {0.1, length_m, 1.5}, -kHallHalfM, 0.0));
  world.boxes.push_back(boxAt("wall_east", {0.1, length_m, 1.5}, kHallHalfM, 0.0));
  for (int i = 0; i < 6; ++i) {
    world.boxes.push_back(boxAt("box_" + std::to_string(i), {0.6, 0.6, 0.7}, -7.5 + 3.0 * i,
                                i % 2 == 0 ? 3.0 : -3.0));
  }
  return world;
}

double speedOf(Simulator& simulator, const Twist2& twist, double simulated_s) {
  double cpu_s = 0.0;
  double done_s = 0.0;
  const int period = static_cast<int>(std::lround(0.05 / simulator.stepSeconds()));
  for (std::uint64_t seed = 1; done_s < simulated_s; ++seed) {
    simulator.reset(seed);
    const double start_s = threadSeconds();
    while (simulator.time() < kRunS) {
      simulator.setCommand(twist);
      simulator.step(std::max(1, period));
    }
    cpu_s += threadSeconds() - start_s;
    done_s += simulator.time();
  }
  return done_s / cpu_s;
}

}  // namespace

SimSpeed measureSimSpeed(const Catalog& catalog, const std::string& object,
                         const std::string& robot, const SimulatorOptions& options,
                         double simulated_s) {
  RobotModel robot_model = catalog.robot(robot);
  robot_model.cameras.clear();  // Physics only.
  const ObjectModel object_model = catalog.object(object);
  const WorldModel world = hall(object_model, robot_model, true);
  Simulator simulator(world, robot_model, {{object_model.name, object_model}}, options);
  Simulator apart(hall(object_model, robot_model, false), robot_model,
                  {{object_model.name, object_model}}, options);
  SimSpeed result;
  result.pushing_all = speedOf(simulator, {kPushSpeedMps, 0.0, 0.0}, simulated_s);
  result.pushing_one = speedOf(apart, {kPushSpeedMps, 0.0, 0.0}, simulated_s);
  result.driving = speedOf(simulator, {-0.1, 0.0, 0.0}, simulated_s);
  const double start_s = threadSeconds();
  for (int i = 0; i < kRecreations; ++i) simulator.setPose("robot", world.map_T_robot);
  result.recreation_s = (threadSeconds() - start_s) / kRecreations;
  return result;
}

}  // namespace casepush
