#pragma once

#include <cstdint>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/tag_detection.h"
#include "physics_world.h"
#include "scene.h"
#include "sensor_timing.h"
#include "sight.h"

namespace casepush::sim {

/// The robot's cameras: what an AprilTag detector would report of their images.
class TagCameras {
 public:
  /// @pre `scene` outlives this.
  TagCameras(const Scene& scene, bool noise, std::uint64_t seed);

  bool isDue(double time_s) const;

  /// Takes the images that are due.
  void update(double time_s, const PhysicsWorld& physics, const Sight& sight);

  /// Those whose latency has passed, oldest first.
  std::vector<TagFrame> take(double time_s) { return waiting_.take(time_s); }

 private:
  struct Camera {
    const CameraModel* model;
    bool noise;
    Random random;
    SampleClock clock;
  };

  TagFrame capture(Camera& camera, double time_s, const PhysicsWorld& physics,
                   const Sight& sight) const;

  const Scene& scene_;
  std::vector<Camera> cameras_;
  DelayLine<TagFrame> waiting_;
};

}  // namespace casepush::sim
