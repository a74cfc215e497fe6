#include "casepush/model/robot_model.h"

#include "casepush/common/input_error.h"
#include "casters.h"
#include "sensor_yaml.h"

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

}  // namespace

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
  model.surface_friction =
      reader.number("surface_friction", 0.0, kMaxSurfaceFriction, model.surface_friction);
  readSensors(reader, model);
  reader.finish();
  return model;
}

}  // namespace casepush
