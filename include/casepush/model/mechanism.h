#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "casepush/model/geometry.h"

namespace casepush {

/// One rigid link of a URDF.
struct Link {
  std::string name;
  double mass_kg = 0.0;
  Eigen::Isometry3d link_T_inertial = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d inertia_kgm2 = Eigen::Matrix3d::Zero();  ///< About the centre of mass.
  std::vector<PlacedShape> collision;                      ///< In the link frame.
  Eigen::Vector4d colour_rgba{0.6, 0.6, 0.6, 1.0};         ///< Of the first visual.
};

enum class JointType { kFixed, kContinuous };

/// Joint of a URDF. `child` of joint i is `links[i + 1]` of the mechanism.
struct Joint {
  std::string name;
  JointType type = JointType::kFixed;
  int parent_link = 0;  ///< Index into links; always smaller than the child's.
  Eigen::Isometry3d parent_T_joint = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Unit, in the joint frame.
  double friction_nm = 0.0;                         ///< Coulomb friction torque.
};

/// A tree of links in depth-first order: link 0 is the root, joint i leads to link i + 1.
/// The root frame is the object or robot frame: z = 0 on the floor, x forward (REP 103).
struct Mechanism {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;

  double massKg() const;
  int linkIndex(const std::string& name) const;  ///< -1 if there is none.

  /// Pose of a link in the root frame with all joints at zero.
  Eigen::Isometry3d root_T_link(int link) const;
};

/// Reads a URDF file.
/// @throws InputError naming file, element and reason: unreadable, not URDF, a link without
/// inertia,
///   a mass that is not positive and finite, an inertia that is not positive definite or breaks the
///   triangle inequality, a joint type other than fixed or continuous (limits and damping are not
///   modelled, so they are refused), a mesh.
Mechanism loadMechanism(const std::filesystem::path& urdf_file);

}  // namespace casepush
