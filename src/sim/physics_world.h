#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "caster_solver.h"
#include "contact_log.h"
#include "furniture.h"
#include "robot_base.h"
#include "scene.h"

namespace casepush::sim {

/// All of a world that moves.
struct WorldState {
  RobotState robot;
  std::vector<FurnitureState> furniture;
};

struct StepOptions {
  double step_s = 1.0 / 240.0;
  int solver_iterations = 30;
};

/// The Bullet world. Built from a scene and a state in well under a millisecond, and never reset:
/// Bullet keeps caches, so that only a new world repeats an old one bit by bit.
class PhysicsWorld {
 public:
  /// @pre `scene` outlives this.
  PhysicsWorld(const Scene& scene, const WorldState& state, const StepOptions& options);

  void setRobotTarget(const Twist2& robot_twist) { robot_.setTarget(robot_twist); }
  void step(ContactLog& contacts);

  WorldState state() const;
  const RobotBase& robot() const { return robot_; }
  const Furniture& furniture(int index) const {
    return *furniture_[static_cast<std::size_t>(index)];
  }

  /// True if nothing but floor and robot crosses the segment.
  bool isClear(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map) const;

  /// "chair_1 (seat) overlaps wall_3" if one of `bodies` overlaps anything; looks before any step.
  std::optional<std::string> findOverlap(const std::vector<std::string>& bodies);

 private:
  void addStatics();
  void configureSolver(const StepOptions& options);
  void readContacts(ContactLog& contacts);

  const Scene& scene_;
  double step_s_;
  std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  CasterSolver solver_;
  btStaticPlaneShape floor_shape_;
  CollisionTag floor_tag_;
  btRigidBody floor_;
  std::vector<std::unique_ptr<btCollisionObject>> boxes_;
  RobotBase robot_;
  std::vector<std::unique_ptr<Furniture>> furniture_;
  std::vector<std::vector<double>> wheel_impulse_ns_;
  btMultiBodyDynamicsWorld world_;  // Last: its destructor still needs all of the above.
};

}  // namespace casepush::sim
