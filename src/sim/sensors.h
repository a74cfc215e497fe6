#pragma once

#include <cstdint>
#include <memory>

#include "localisation.h"
#include "physics_world.h"
#include "range_sensor.h"
#include "sight.h"
#include "tag_camera.h"

namespace casepush::sim {

/// All that the robot senses. Nothing here acts back on the physics.
struct Sensors {
  /// @pre `scene` outlives this.
  Sensors(const Scene& scene, bool noise, std::uint64_t seed);

  /// After each step. @param scanning  Whether the scans of range sensors are wanted.
  void update(double time_s, double step_s, const PhysicsWorld& physics, bool scanning);

  Sight sight;
  TagCameras cameras;
  RangeSensors range_sensors;
  Localisation localisation;
};

}  // namespace casepush::sim
