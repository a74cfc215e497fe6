#pragma once

#include <Eigen/Core>
#include <vector>

#include "furniture_blueprint.h"

namespace casepush::sim {

/// What turns about one swivel axis: fork and wheels. Vectors along the root's axes at angle zero.
struct PlanarSwivel {
  int joint = 0;       ///< Index of the state's joint angle.
  double sense = 1.0;  ///< -1 if the joint's axis points down.
  Eigen::Vector2d chassis_p_pivot = Eigen::Vector2d::Zero();  ///< From the chassis' centre of mass.
  double mass_kg = 0.0;
  Eigen::Vector2d pivot_p_com = Eigen::Vector2d::Zero();
  double inertia_kgm2 = 0.0;  ///< About its own centre of mass.
  double friction_nm = 0.0;
};

/// A wheel on the floor.
struct PlanarWheel {
  int joint = 0;
  int swivel = -1;             ///< -1: fixed to the chassis.
  bool holds_bearing = false;  ///< The first wheel of its swivel.
  /// Contact from the swivel's pivot or, if fixed, from the chassis' centre of mass.
  Eigen::Vector2d contact_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d rolling = Eigen::Vector2d::UnitX();  ///< Way of travel at positive axle speed.
  double radius_m = 0.0;
  double spin_mass_kg = 0.0;  ///< Moment of inertia about the axle over radius squared.
  double friction_nm = 0.0;   ///< Of the axle's bearing.
};

/// An object's constants in the plane of the floor.
///
/// The chassis is all that neither swivels nor hangs on a swivel; fixed wheels are part of it.
struct PlanarModel {
  Eigen::Vector2d root_p_com = Eigen::Vector2d::Zero();  ///< Of the chassis.
  double chassis_mass_kg = 0.0;
  double chassis_inertia_kgm2 = 0.0;  ///< About its centre of mass.
  double mass_kg = 0.0;               ///< Of the whole object.
  double com_height_m = 0.0;          ///< Of the whole object.
  std::vector<PlanarSwivel> swivels;
  std::vector<PlanarWheel> wheels;     ///< In the order of the casters.
  std::vector<Eigen::Vector2d> skids;  ///< Without wheels: where it stands, from the chassis' com.
};

/// @throws InputError naming the object if it does not stand on at least three points with its
///   centre of mass above their triangle or polygon.
PlanarModel makePlanarModel(const FurnitureBlueprint& blueprint);

}  // namespace casepush::sim
