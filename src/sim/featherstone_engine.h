#pragma once

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <memory>
#include <vector>

#include "caster_solver.h"
#include "collision_space.h"
#include "engine.h"
#include "featherstone_furniture.h"

namespace casepush::sim {

/// The reference: Bullet's dynamics in space, casters as Featherstone joints.
class FeatherstoneEngine final : public Engine {
 public:
  /// @pre `scene` and `space` outlive this.
  FeatherstoneEngine(const Scene& scene, CollisionSpace& space, const WorldState& state,
                     const StepOptions& options);

  btCollisionWorld& collisions() override { return world_; }
  const btCollisionWorld& collisions() const override { return world_; }
  void setRobotTarget(const Twist2& robot_twist) override { robot_.setTarget(robot_twist); }
  void step(ContactLog& contacts) override;
  const Robot& robot() const override { return robot_; }
  const Furniture& furniture(int index) const override {
    return *furniture_[static_cast<std::size_t>(index)];
  }

 private:
  void configureSolver(const StepOptions& options);
  void readContacts(ContactLog& contacts);

  double step_s_;
  CasterSolver solver_;
  btStaticPlaneShape floor_shape_;
  CollisionTag floor_tag_;
  btRigidBody floor_;
  RobotBase robot_;
  std::vector<std::unique_ptr<FeatherstoneFurniture>> furniture_;
  std::vector<std::vector<double>> wheel_impulse_ns_;
  btMultiBodyDynamicsWorld world_;  // Last: its destructor still needs all of the above.
};

}  // namespace casepush::sim
