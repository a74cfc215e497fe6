#pragma once

#include <string>
#include <vector>

#include "casepush/model/mechanism.h"
#include "casepush/model/sensors.h"

namespace casepush {

/// What the base can do and what casepush asks of it.
struct RobotLimits {
  double max_speed_mps = 0.5;
  double max_yaw_rate_rps = 1.0;
  double max_acceleration_mps2 = 0.8;
  double max_yaw_acceleration_rps2 = 2.0;
  double max_force_n = 150.0;
  double max_torque_nm = 40.0;
};

/// An omnidirectional robot: one URDF (fixed joints only) and the YAML beside it.
struct RobotModel {
  std::string name;
  Mechanism mechanism;
  RobotLimits limits;
  std::vector<CameraModel> cameras;
  std::vector<RangeSensorModel> range_sensors;
  OdometryModel odometry;
  LocalisationModel localisation;
  Solid
      solid;  ///< Every collision shape in the base frame; `part` is the link (base, basket, body).
  double radius_m = 0.0;  ///< Circumscribed radius of the solid.
  /// Coulomb coefficient; those of two bodies in contact are multiplied.
  double surface_friction = 0.6;
};

/// Takes a sensor away, or makes it exact: a camera or range sensor by its name, or "odometry" or
/// "localisation", which can only be made exact.
/// @throws InputError if there is no such sensor, naming those there are.
void disableSensor(RobotModel& robot, const std::string& name);
void makeSensorExact(RobotModel& robot, const std::string& name);

/// Reads `<stem>.urdf` and `<stem>.yaml`. @throws InputError naming file, element and reason.
RobotModel loadRobotModel(const std::filesystem::path& urdf_file);

}  // namespace casepush
