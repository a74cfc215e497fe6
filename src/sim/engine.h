#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <vector>

#include "contact_log.h"
#include "furniture.h"
#include "robot_base.h"

namespace casepush::sim {

/// All of a world that moves.
struct WorldState {
  RobotState robot;
  std::vector<FurnitureState> furniture;
};

struct StepOptions {
  double step_s = 1.0 / 240.0;
  int solver_iterations = 30;
  CasterModel caster_model = CasterModel::kFeatherstone;
};

/// Moves robot and furniture: one implementation for each model of casters.
class Engine {
 public:
  virtual ~Engine() = default;

  virtual btCollisionWorld& collisions() = 0;
  virtual const btCollisionWorld& collisions() const = 0;
  virtual void setRobotTarget(const Twist2& robot_twist) = 0;
  virtual void step(ContactLog& contacts) = 0;
  virtual const Robot& robot() const = 0;
  virtual const Furniture& furniture(int index) const = 0;
};

}  // namespace casepush::sim
