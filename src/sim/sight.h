#pragma once

#include <memory>
#include <vector>

#include "collision_space.h"
#include "physics_world.h"
#include "scene.h"

namespace casepush::sim {

/// What the robot's sensors can see: every shape of the URDFs, wheels and the robot included, and
/// the floor, at z = 0.
///
/// A collision world of its own, so that both caster models look the same whatever shapes they
/// collide with, and that bodies are moved only when a sensor looks.
class Sight {
 public:
  /// @pre `scene` outlives this.
  explicit Sight(const Scene& scene);

  /// Moves everything to where it is now.
  void look(const PhysicsWorld& physics);

  /// True if nothing but floor and robot crosses the segment.
  bool isClear(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map) const;

  struct Hit {
    double range_m;
    bool is_robot;
  };
  /// The first thing along a ray; `range_m` is beyond `max_range_m` if there is none.
  /// @pre `direction_map` is a unit vector; the origin is not inside of a shape.
  Hit cast(const Eigen::Vector3d& from_map, const Eigen::Vector3d& direction_map,
           double max_range_m) const;

 private:
  struct Link {
    int index = 0;
    CompoundShape shape;
    btCollisionObject object;
  };
  using Links = std::vector<std::unique_ptr<Link>>;

  void add(Link& link, int group);

  std::vector<Links> furniture_;
  Link robot_;
  CollisionSpace space_;
  btCollisionWorld world_;  // Last: it lets go of all objects when it ends.
};

}  // namespace casepush::sim
