#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "casepush/model/mechanism.h"

namespace casepush {

constexpr double kLargestLoad_kg = 80.0;

/// Something heavy that lies on an object and moves with it: a box of even density whose edges run
/// along the object's axes.
///
/// It has weight and inertia but no surface: nothing bumps into it and no tag hides behind it.
struct Load {
  double mass_kg = 0.0;  ///< 0: none.
  Eigen::Vector2d object_p_centre_m = Eigen::Vector2d::Zero();
  /// Of its centre above the floor; none: it stands on the highest surface below that place.
  std::optional<double> height_m = std::nullopt;
  Eigen::Vector3d size_m{0.3, 0.3, 0.2};
};

/// The load with its height, if an object can carry it there.
/// @param carrier  The object; its collision shapes are its footprint and its surfaces.
/// @throws InputError at `where` naming value and bounds: a mass outside of 0 to 80 kg, a size
///   outside of 0.01 to 3 m, a place that no collision shape of the carrier lies above or below, a
///   box that reaches into the floor or hangs above the carrier's highest point.
Load placedLoad(const Load& load, const Mechanism& carrier, const std::string& where);

/// About its centre, along the object's axes. @pre Its size is finite.
Eigen::Matrix3d inertiaOf(const Load& load);

}  // namespace casepush
