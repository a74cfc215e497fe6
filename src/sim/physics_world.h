#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision_space.h"
#include "engine.h"
#include "scene.h"

namespace casepush::sim {

/// The world as it moves. Built from a scene and a state in well under a millisecond, and never
/// reset: Bullet keeps caches, so that only a new world repeats an old one bit by bit.
class PhysicsWorld {
 public:
  /// @pre `scene` outlives this.
  /// @throws InputError if the caster model cannot represent an object.
  PhysicsWorld(const Scene& scene, const WorldState& state, const StepOptions& options);

  void setRobotTarget(const Twist2& robot_twist) { engine_->setRobotTarget(robot_twist); }
  void step(ContactLog& contacts) { engine_->step(contacts); }

  WorldState state() const;
  const Robot& robot() const { return engine_->robot(); }
  const Furniture& furniture(int index) const { return engine_->furniture(index); }

  /// "chair_1 (seat) overlaps wall_3" if one of `bodies` overlaps anything; looks before any step.
  std::optional<std::string> findOverlap(const std::vector<std::string>& bodies);

 private:
  const Scene& scene_;
  CollisionSpace space_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace casepush::sim
