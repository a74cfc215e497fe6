#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/tag_detection.h"
#include "physics_world.h"
#include "scene.h"

namespace casepush::sim {

/// The robot's cameras: what an AprilTag detector would report of their images.
class TagCameras {
 public:
  /// @pre `scene` outlives this.
  TagCameras(const Scene& scene, bool noise, std::uint64_t seed);

  /// Takes the images that are due.
  void update(double time_s, const PhysicsWorld& physics);

  /// Those whose latency has passed, oldest first.
  std::vector<TagFrame> take(double time_s);

 private:
  struct Pending {
    double due_s;
    TagFrame frame;
  };

  TagFrame capture(const CameraModel& camera, double time_s, const PhysicsWorld& physics);
  bool isVisible(const Eigen::Isometry3d& map_T_camera, const Eigen::Isometry3d& map_T_tag,
                 double size_m, const PhysicsWorld& physics) const;

  const Scene& scene_;
  bool noise_;
  Random random_;
  std::vector<std::int64_t> images_taken_;  // By camera.
  std::deque<Pending> pending_;
};

}  // namespace casepush::sim
