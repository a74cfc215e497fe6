#include "casepush/model/sensors.h"

#include <cmath>

#include "casepush/common/input_error.h"
#include "casepush/model/robot_model.h"

namespace casepush {
namespace {

/// Angle of the i-th of n directions that share a field of view evenly, ends included; all around,
/// the last one keeps its distance from the first.
double spread(int i, int n, double fov_rad) {
  if (n == 1) return 0.0;
  const bool all_around = fov_rad > 2.0 * M_PI - 1e-6;
  return -0.5 * fov_rad + i * fov_rad / (all_around ? n : n - 1);
}

template <typename Change>
bool changeNamed(RobotModel& robot, const std::string& name, const Change& change) {
  bool found = false;
  const auto visit = [&](auto& sensors) {
    for (auto& sensor : sensors) {
      if (sensor.name != name) continue;
      change(sensor.switches);
      found = true;
    }
  };
  visit(robot.cameras);
  visit(robot.range_sensors);
  return found;
}

std::string namesOf(const RobotModel& robot) {
  std::string text;
  for (const CameraModel& camera : robot.cameras) text += camera.name + ", ";
  for (const RangeSensorModel& sensor : robot.range_sensors) text += sensor.name + ", ";
  return text + "odometry, localisation";
}

[[noreturn]] void refuseName(const RobotModel& robot, const std::string& name) {
  throw InputError("robot " + robot.name,
                   "has no sensor '" + name + "'; there are " + namesOf(robot));
}

}  // namespace

double CameraModel::focalPx() const { return 0.5 * width_px / std::tan(0.5 * horizontal_fov_rad); }

Eigen::Vector3d RangeSensorModel::direction(int layer, int beam) const {
  const double azimuth = spread(beam, beams, horizontal_fov_rad);
  const double elevation = spread(layer, layers, vertical_fov_rad);
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

void disableSensor(RobotModel& robot, const std::string& name) {
  if (name == "odometry" || name == "localisation") {
    throw InputError("robot " + robot.name, name +
                                                " cannot be disabled, for every node needs the "
                                                "robot's pose; it can be made exact");
  }
  if (!changeNamed(robot, name, [](SensorSwitches& switches) { switches.enabled = false; })) {
    refuseName(robot, name);
  }
}

void makeSensorExact(RobotModel& robot, const std::string& name) {
  const auto exact = [](SensorSwitches& switches) { switches.noise = false; };
  if (name == "odometry") return exact(robot.odometry.switches);
  if (name == "localisation") return exact(robot.localisation.switches);
  if (!changeNamed(robot, name, exact)) refuseName(robot, name);
}

}  // namespace casepush
