#include "furniture.h"

#include <algorithm>
#include <cmath>

#include "bullet_conversions.h"

namespace casepush::sim {

FurnitureState stateAtRest(const FurnitureBlueprint& blueprint, const Pose2& map_T_object,
                           Random& random) {
  FurnitureState state;
  state.map_T_base = toBullet(toSpatial(map_T_object) * blueprint.bodies[0].mass.root_T_com);
  const std::size_t joints = blueprint.bodies.size() - 1;
  state.joint_rad.assign(joints, 0.0);
  state.joint_rps.assign(joints, 0.0);
  for (std::size_t i = 0; i < joints; ++i) {
    if (blueprint.bodies[i + 1].swivels) state.joint_rad[i] = random.uniform(-M_PI, M_PI);
  }
  const std::size_t wheels = blueprint.wheel_radius_m.size();
  state.wheel_load_n.assign(wheels,
                            blueprint.mass_kg * kGravity_mps2 / std::max<double>(1.0, wheels));
  return state;
}

FurnitureState carriedOver(const FurnitureState& state, const FurnitureBlueprint& from,
                           const FurnitureBlueprint& to) {
  FurnitureState result = state;
  const Eigen::Isometry3d com_T_root = from.bodies[0].mass.root_T_com.inverse();
  result.map_T_base =
      state.map_T_base * toBullet(Eigen::Isometry3d(com_T_root * to.bodies[0].mass.root_T_com));
  const btVector3 arm = result.map_T_base.getOrigin() - state.map_T_base.getOrigin();
  result.base_velocity_mps += state.base_omega_rps.cross(arm);
  for (double& load_n : result.wheel_load_n) load_n *= to.mass_kg / from.mass_kg;
  return result;
}

double surfaceFriction(const FurnitureBlueprint& blueprint, const BodyBlueprint& body,
                       const Floor& floor) {
  const bool rolls = !blueprint.wheel_radius_m.empty();
  return body.wheel >= 0 || !rolls ? floor.friction : blueprint.model->surface_friction;
}

}  // namespace casepush::sim
