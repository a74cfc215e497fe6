#include <charconv>
#include <cmath>
#include <sstream>

#include "casepush/common/atomic_file.h"
#include "casepush/common/check.h"
#include "casepush/model/world_model.h"

namespace casepush {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;

/// The shortest text that reads back as the same number.
std::string text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return {buffer, result.ptr};
}

template <typename Vector>
std::string list(const Vector& values) {
  std::string result = "[";
  for (int i = 0; i < values.size(); ++i) {
    result += (i > 0 ? ", " : "") + text(values(i));
  }
  return result + "]";
}

/// A scalar that YAML reads as this text and nothing else.
std::string quoted(const std::string& value) {
  std::string result = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += c;
  }
  return result + "\"";
}

Eigen::Matrix3d turn(double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// Degrees that give an angle back when they are read. Most angles have come from degrees with few
/// digits, which `isSame` recognises; of the others, the nearest.
template <typename IsSame>
double degreesOf(double yaw_rad, const IsSame& isSame) {
  const double degrees = yaw_rad / kRadPerDeg;
  for (const double digits : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    const double rounded = std::round(degrees * digits) / digits;
    if (isSame(rounded * kRadPerDeg)) {
      return rounded;
    }
  }
  for (const double neighbour : {std::nextafter(degrees, -1e3), std::nextafter(degrees, 1e3)}) {
    if (isSame(neighbour * kRadPerDeg)) {
      return neighbour;
    }
  }
  return degrees;
}

std::string poseText(const Pose2& pose) {
  const double yaw_deg =
      degreesOf(pose.yaw(), [&](double rad) { return wrapAngle(rad) == pose.yaw(); });
  return "xy: " + list(pose.position()) + ", yaw_deg: " + text(yaw_deg);
}

std::string loadText(const Load& load) {
  return "{mass_kg: " + text(load.mass_kg) + ", xy: " + list(load.object_p_centre_m) +
         (load.height_m ? ", height_m: " + text(*load.height_m) : "") +
         ", size_m: " + list(load.size_m) + "}";
}

std::string boxText(const StaticBox& box) {
  const Eigen::Matrix3d& rotation = box.map_T_box.linear();
  CASEPUSH_CHECK((rotation.col(2) - Eigen::Vector3d::UnitZ()).norm() < 1e-9,
                 "box " << box.name << " is not upright");
  const double yaw_deg = degreesOf(std::atan2(rotation(1, 0), rotation(0, 0)),
                                   [&](double rad) { return turn(rad) == rotation; });
  return "  - {name: " + quoted(box.name) + ", size_m: " + list(box.box.size_m) +
         ", xyz: " + list(box.map_T_box.translation()) +
         (yaw_deg == 0.0 ? "" : ", yaw_deg: " + text(yaw_deg)) + "}\n";
}

}  // namespace

std::string worldYaml(const WorldModel& world) {
  std::ostringstream yaml;
  yaml << "bounds: {min: " << list(world.min_m) << ", max: " << list(world.max_m) << "}\n"
       << "floor: {friction: " << text(world.floor.friction)
       << ", rolling_lever_arm_m: " << text(world.floor.rolling_lever_arm_m) << "}\n";
  if (world.static_map) {
    yaml << "static_map: " << quoted(std::filesystem::absolute(*world.static_map).string()) << "\n";
  }
  if (world.point_cloud) {
    const PointCloudFile& cloud = *world.point_cloud;
    yaml << "point_cloud: {file: " << quoted(std::filesystem::absolute(cloud.file).string())
         << ", resolution_m: " << text(cloud.resolution_m)
         << ", height_m: " << list(Eigen::Vector2d(cloud.low_m, cloud.high_m)) << "}\n";
  }
  yaml << "\nrobot: {model: " << quoted(world.robot) << ", " << poseText(world.map_T_robot) << "}\n"
       << "objects:\n";
  for (const ObjectPlacement& object : world.objects) {
    yaml << "  - {id: " << quoted(object.id) << ", model: " << quoted(object.model) << ", "
         << poseText(object.map_T_object) << ", tag_offset: " << object.tag_offset
         << (object.load ? ", load: " + loadText(*object.load) : "") << "}\n";
  }
  if (world.objects.empty()) {
    yaml << "  []\n";
  }
  if (world.goal) {
    yaml << "goal: {" << poseText(*world.goal) << "}\n";
  }
  yaml << "\nboxes:\n";
  for (const StaticBox& box : world.boxes) {
    yaml << boxText(box);
  }
  if (world.boxes.empty()) {
    yaml << "  []\n";
  }
  return yaml.str();
}

void saveWorldModel(const WorldModel& world, const std::filesystem::path& yaml_file) {
  writeFileAtomically(yaml_file, worldYaml(world));
}

}  // namespace casepush
