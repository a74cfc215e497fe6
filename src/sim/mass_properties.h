#pragma once

#include <vector>

#include "casepush/model/load.h"
#include "casepush/model/mechanism.h"

namespace casepush::sim {

/// Mass, and the frame of the centre of mass along the principal axes of inertia.
struct MassProperties {
  double mass_kg = 0.0;
  Eigen::Isometry3d root_T_com = Eigen::Isometry3d::Identity();
  Eigen::Vector3d inertia_kgm2 = Eigen::Vector3d::Zero();  ///< Principal moments.

  /// Inertia about the centre of mass along the root's axes.
  Eigen::Matrix3d rootInertia() const;
};

/// Of links that are rigidly joined, at zero joint angles, and of what lies on them.
/// @pre their mass is positive; the load has a height.
MassProperties composeMass(const Mechanism& mechanism, const std::vector<int>& links,
                           const std::optional<Load>& load = std::nullopt);

}  // namespace casepush::sim
