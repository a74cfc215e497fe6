#include "casepush/model/robot_model.h"

#include <cmath>
#include <set>

#include "casepush/common/input_error.h"
#include "casters.h"
#include "yaml_pose.h"

namespace casepush {
namespace {

constexpr double kMaxSurfaceFriction = 2.0;

RobotLimits readLimits(YamlReader reader) {
  RobotLimits limits;
  limits.max_speed_mps = reader.number("max_speed_mps", 0.05, 3.0);
  limits.max_yaw_rate_rps = reader.number("max_yaw_rate_rps", 0.05, 10.0);
  limits.max_acceleration_mps2 = reader.number("max_acceleration_mps2", 0.05, 20.0);
  limits.max_yaw_acceleration_rps2 = reader.number("max_yaw_acceleration_rps2", 0.05, 50.0);
  limits.max_force_n = reader.number("max_force_n", 1.0, 5000.0);
  limits.max_torque_nm = reader.number("max_torque_nm", 0.1, 5000.0);
  reader.finish();
  return limits;
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

std::vector<CameraModel> readCameras(YamlReader& reader) {
  std::vector<CameraModel> cameras;
  std::set<std::string> names;
  for (YamlReader& entry : reader.children("cameras")) {
    cameras.push_back(readCamera(entry));
    if (!names.insert(cameras.back().name).second) {
      throw InputError(entry.where("name"), cameras.back().name + " is taken by another camera");
    }
  }
  if (cameras.empty()) {
    throw InputError(reader.where("cameras"), "must list at least one camera");
  }
  return cameras;
}

}  // namespace

double CameraModel::focalPx() const { return 0.5 * width_px / std::tan(0.5 * horizontal_fov_rad); }

RobotModel loadRobotModel(const std::filesystem::path& urdf_file) {
  RobotModel model;
  model.name = urdf_file.stem().string();
  model.mechanism = loadMechanism(urdf_file);
  for (const Joint& joint : model.mechanism.joints) {
    if (joint.type != JointType::kFixed) {
      throw InputError(urdf_file.string() + ": joint '" + joint.name + "'",
                       "moves; a robot's joints must all be fixed");
    }
  }
  model.solid = sweptSolid(model.mechanism, {});
  if (model.solid.empty()) {
    throw InputError(urdf_file.string(), "has no collision shapes");
  }
  model.radius_m = circumscribedRadius(model.solid);

  YamlReader reader =
      YamlReader::fromFile(std::filesystem::path(urdf_file).replace_extension("yaml"));
  model.limits = readLimits(reader.child("limits"));
  model.cameras = readCameras(reader);
  model.surface_friction =
      reader.number("surface_friction", 0.0, kMaxSurfaceFriction, model.surface_friction);
  reader.finish();
  return model;
}

}  // namespace casepush
