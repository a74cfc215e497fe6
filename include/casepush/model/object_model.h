#pragma once

#include <string>
#include <vector>

#include "casepush/model/mechanism.h"

namespace casepush {

/// One wheel on the floor, with or without a swivel.
struct Caster {
  int swivel_joint = -1;  ///< Index into mechanism.joints; -1 for a fixed wheel.
  int wheel_joint = -1;
  double wheel_radius_m = 0.0;
  double trail_m = 0.0;  ///< Horizontal distance from swivel axis to wheel axle.
};

/// A fiducial tag on an object. The tag's frame is AprilTag's: x right, y down, z into the tag,
/// seen from the front.
struct TagMount {
  int id = 0;
  double size_m = 0.0;  ///< Edge length of the black square.
  Eigen::Isometry3d object_T_tag = Eigen::Isometry3d::Identity();
};

/// A pushable object: one URDF and the YAML beside it.
struct ObjectModel {
  std::string name;        ///< File stem, e.g. "office_chair".
  std::string class_name;  ///< Kind of furniture, e.g. "chair".
  Mechanism mechanism;
  std::vector<Caster> casters;  ///< Empty only for objects declared as sliding.
  std::vector<TagMount> tags;
  /// Coulomb coefficient of what is not a wheel; those of two bodies in contact are multiplied.
  double surface_friction = 0.6;

  /// For collision checking: every link at zero joint angles, and each swivelling caster as the
  /// cylinder it can sweep.
  Solid solid;
  double radius_m = 0.0;           ///< Circumscribed radius of the solid.
  double gyration_radius_m = 0.0;  ///< About the vertical axis through the object's origin.
};

/// Reads `<stem>.urdf` and `<stem>.yaml`.
/// @param urdf_file  Path of the URDF; the YAML is expected beside it.
/// @throws InputError naming file, element and reason.
ObjectModel loadObjectModel(const std::filesystem::path& urdf_file);

}  // namespace casepush
