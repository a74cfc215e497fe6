#include "sensor_yaml.h"

#include <cmath>
#include <limits>
#include <set>
#include <sstream>

#include "casepush/common/input_error.h"
#include "yaml_pose.h"

namespace casepush {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kMostRays = 200000;           // of one scan
constexpr double kMostRaysPerSecond = 2e6;  // about a second's work of one core, at a guess

SensorSwitches readSwitches(YamlReader& reader, bool can_be_absent = true) {
  SensorSwitches switches;
  if (can_be_absent) switches.enabled = reader.flag("enabled", switches.enabled);
  switches.noise = reader.flag("noise", switches.noise);
  switches.seed =
      static_cast<std::uint64_t>(reader.integer("seed", 0, std::numeric_limits<int>::max(), 0));
  return switches;
}

/// Radians of an optional key in degrees.
double readAngleOr(YamlReader& reader, const std::string& key, double high_deg,
                   double default_rad) {
  return reader.has(key) ? readAngle(reader, key, 0.0, high_deg) : default_rad;
}

/// The YAML gives the pose of the camera's housing (x along the view, z up); the optical frame is
/// turned against it as REP 103 says.
Eigen::Isometry3d toOptical(const Eigen::Isometry3d& base_T_housing) {
  Eigen::Isometry3d housing_T_optical = Eigen::Isometry3d::Identity();
  housing_T_optical.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return base_T_housing * housing_T_optical;
}

CameraModel readCamera(YamlReader& reader) {
  CameraModel camera;
  camera.name = reader.text("name");
  camera.switches = readSwitches(reader);
  camera.base_T_camera = toOptical(readPose3(reader));
  camera.width_px = reader.integer("width_px", 16, 10000);
  camera.height_px = reader.integer("height_px", 16, 10000);
  camera.horizontal_fov_rad = readAngle(reader, "horizontal_fov_deg", 1.0, 170.0);
  camera.rate_hz = reader.number("rate_hz", 0.1, 240.0);
  camera.latency_s = reader.number("latency_s", 0.0, 5.0);
  camera.max_range_m = reader.number("max_range_m", 0.1, 100.0);
  camera.max_view_angle_rad = readAngle(reader, "max_view_angle_deg", 1.0, 89.0);
  camera.corner_noise_px = reader.number("corner_noise_px", 0.0, 20.0);
  camera.dropout = reader.number("dropout", 0.0, 1.0);
  reader.finish();
  return camera;
}

bool isInside(const PlacedShape& placed, const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = placed.frame_T_shape.inverse() * point;
  if (const auto* box = std::get_if<Box>(&placed.shape)) {
    return (p.cwiseAbs().array() <= 0.5 * box->size_m.array()).all();
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    return p.head<2>().norm() <= cylinder->radius_m && std::abs(p.z()) <= 0.5 * cylinder->length_m;
  }
  return p.norm() <= std::get<Sphere>(placed.shape).radius_m;
}

/// A sensor inside the robot would see nothing, or the shape's far side.
void checkMount(const YamlReader& reader, const Solid& solid, const Eigen::Vector3d& mount) {
  for (const PlacedShape& placed : solid) {
    if (!isInside(placed, mount)) continue;
    std::ostringstream text;
    text << "(" << mount.x() << ", " << mount.y() << ", " << mount.z() << ") is inside the robot's "
         << placed.part << ", where it sees nothing; must be outside";
    throw InputError(reader.where("xyz"), text.str());
  }
}

void checkRays(const YamlReader& reader, const RangeSensorModel& sensor) {
  const double rays_per_s = sensor.rays() * sensor.rate_hz;
  if (sensor.rays() <= kMostRays && rays_per_s <= kMostRaysPerSecond) return;
  std::ostringstream text;
  text << "casts " << sensor.rays() << " rays a scan and " << rays_per_s
       << " a second; must be at most " << kMostRays << " and " << kMostRaysPerSecond
       << ": use fewer beams or layers, or a lower rate";
  throw InputError(reader.where(), text.str());
}

RangeSensorModel readRangeSensor(YamlReader& reader, const Solid& solid) {
  RangeSensorModel sensor;
  sensor.name = reader.text("name");
  sensor.switches = readSwitches(reader);
  sensor.base_T_sensor = readPose3(reader);
  checkMount(reader, solid, sensor.base_T_sensor.translation());
  sensor.beams = reader.integer("beams", 1, 10000);
  sensor.layers = reader.integer("layers", 1, 1000, sensor.layers);
  sensor.horizontal_fov_rad = readAngle(reader, "horizontal_fov_deg", 0.0, 360.0);
  sensor.vertical_fov_rad = readAngleOr(reader, "vertical_fov_deg", 179.0, 0.0);
  sensor.max_range_m = reader.number("max_range_m", 0.1, 200.0);
  sensor.min_range_m = reader.number("min_range_m", 0.0, sensor.max_range_m, sensor.min_range_m);
  sensor.rate_hz = reader.number("rate_hz", 0.1, 240.0);
  sensor.latency_s = reader.number("latency_s", 0.0, 5.0, sensor.latency_s);
  sensor.noise_m = reader.number("noise_m", 0.0, 1.0);
  sensor.noise_per_range = reader.number("noise_per_range", 0.0, 0.5, sensor.noise_per_range);
  sensor.dropout = reader.number("dropout", 0.0, 1.0, sensor.dropout);
  reader.finish();
  checkRays(reader, sensor);
  return sensor;
}

OdometryModel readOdometry(YamlReader reader) {
  OdometryModel model;
  model.switches = readSwitches(reader, false);
  model.scale = reader.number("scale", 0.0, 0.1, model.scale);
  model.turn_scale = reader.number("turn_scale", 0.0, 0.1, model.turn_scale);
  const auto walk = [&reader](const char* key, double& value) {
    value = reader.number(key, 0.0, 0.5, value);
  };
  walk("position_per_metre_m", model.position_per_metre_m);
  walk("position_per_turn_m", model.position_per_turn_m);
  model.yaw_per_metre_rad = readAngleOr(reader, "yaw_per_metre_deg", 30.0, model.yaw_per_metre_rad);
  model.yaw_per_turn_rad = readAngleOr(reader, "yaw_per_turn_deg", 30.0, model.yaw_per_turn_rad);
  reader.finish();
  return model;
}

LocalisationModel readLocalisation(YamlReader reader) {
  LocalisationModel model;
  model.switches = readSwitches(reader, false);
  model.position_sigma_m = reader.number("position_sigma_m", 0.0, 1.0, model.position_sigma_m);
  model.yaw_sigma_rad = readAngleOr(reader, "yaw_sigma_deg", 45.0, model.yaw_sigma_rad);
  model.correlation_s = reader.number("correlation_s", 0.001, 1e6, model.correlation_s);
  model.position_bound_m =
      reader.number("position_bound_m", 0.0, 5.0, 3.0 * model.position_sigma_m);
  model.yaw_bound_rad = readAngleOr(reader, "yaw_bound_deg", 180.0, 3.0 * model.yaw_sigma_rad);
  reader.finish();
  return model;
}

void takeName(const YamlReader& entry, const std::string& name, std::set<std::string>& names) {
  if (!names.insert(name).second) {
    throw InputError(entry.where("name"), name + " is taken by another sensor");
  }
}

}  // namespace

void readSensors(YamlReader& reader, RobotModel& robot) {
  std::set<std::string> names{"odometry", "localisation"};
  for (YamlReader& entry : reader.children("cameras")) {
    robot.cameras.push_back(readCamera(entry));
    takeName(entry, robot.cameras.back().name, names);
  }
  if (robot.cameras.empty()) {
    throw InputError(reader.where("cameras"), "must list at least one camera");
  }
  for (YamlReader& entry : reader.children("range_sensors")) {
    robot.range_sensors.push_back(readRangeSensor(entry, robot.solid));
    takeName(entry, robot.range_sensors.back().name, names);
  }
  if (auto odometry = reader.optionalChild("odometry")) {
    robot.odometry = readOdometry(std::move(*odometry));
  }
  if (auto localisation = reader.optionalChild("localisation")) {
    robot.localisation = readLocalisation(std::move(*localisation));
  }
}

}  // namespace casepush
