#pragma once

#include <string>
#include <vector>

#include "casepush/model/mechanism.h"

namespace casepush {

/// A pinhole camera that finds tags. Its optical frame is REP 103's: x right, y down, z forward.
struct CameraModel {
  std::string name;
  Eigen::Isometry3d base_T_camera = Eigen::Isometry3d::Identity();
  int width_px = 640;
  int height_px = 480;
  double horizontal_fov_rad = 1.2;
  double rate_hz = 20.0;
  double latency_s = 0.0;
  double max_range_m = 5.0;
  double max_view_angle_rad = 1.2;  ///< Between the tag's normal and the line of sight.
  double corner_noise_px = 0.3;     ///< Standard deviation of each tag corner in the image.
  double dropout = 0.02;            ///< Probability that a visible tag is not reported.

  double focalPx() const;
};

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
  Solid
      solid;  ///< Every collision shape in the base frame; `part` is the link (base, basket, body).
  double radius_m = 0.0;  ///< Circumscribed radius of the solid.
  /// Coulomb coefficient; those of two bodies in contact are multiplied.
  double surface_friction = 0.6;
};

/// Reads `<stem>.urdf` and `<stem>.yaml`. @throws InputError naming file, element and reason.
RobotModel loadRobotModel(const std::filesystem::path& urdf_file);

}  // namespace casepush
