#pragma once

#include <cstdint>

#include "engine.h"
#include "scene.h"

namespace casepush::sim {

/// Everything at its start, with swivels from a seed.
inline WorldState restingState(const Scene& scene, std::uint64_t seed = 1) {
  Random random(seed);
  WorldState state;
  state.robot = stateAtRest(scene.robot_blueprint, scene.world.map_T_robot);
  for (std::size_t i = 0; i < scene.furniture.size(); ++i) {
    state.furniture.push_back(
        stateAtRest(scene.furniture[i], scene.world.objects[i].map_T_object, random));
  }
  return state;
}

/// A cart of scenes.h that rolls along x with all swivels at one angle.
inline void setRolling(FurnitureState& state, double speed_mps, double swivel_rad,
                       double radius_m) {
  state.base_velocity_mps = btVector3(speed_mps, 0, 0);
  // Order of the joints: swivel, axle, swivel, axle, ... With fixed wheels: axle, axle, ...
  const bool swivels = state.joint_rad.size() == 8;
  for (std::size_t i = 0; i < state.joint_rad.size(); ++i) {
    const bool is_axle = !swivels || i % 2 == 1;
    state.joint_rad[i] = is_axle ? 0.0 : swivel_rad;
    state.joint_rps[i] = is_axle ? speed_mps / radius_m : 0.0;
  }
}

}  // namespace casepush::sim
