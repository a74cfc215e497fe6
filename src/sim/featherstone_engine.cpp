#include "featherstone_engine.h"

#include <algorithm>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

btRigidBody::btRigidBodyConstructionInfo floorInfo(btCollisionShape* shape) {
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shape);
  info.m_friction = 1.0;  // Wheels carry the coefficient of the pair.
  return info;
}

}  // namespace

FeatherstoneEngine::FeatherstoneEngine(const Scene& scene, CollisionSpace& space,
                                       const WorldState& state, const StepOptions& options)
    : step_s_(options.step_s),
      floor_shape_(btVector3(0, 0, 1), 0.0),
      floor_(floorInfo(&floor_shape_)),
      robot_(scene.robot_blueprint, state.robot, floor_),
      world_(&space.dispatcher(), &space.broadphase(), &solver_, space.configuration()) {
  configureSolver(options);
  floor_tag_.kind = CollisionTag::Kind::kFloor;
  floor_.setUserPointer(&floor_tag_);
  world_.addRigidBody(&floor_, kFloorGroup, kFurnitureGroup | kWheelGroup);
  space.addStatics(world_);
  robot_.addTo(world_);
  for (std::size_t i = 0; i < scene.furniture.size(); ++i) {
    furniture_.push_back(std::make_unique<FeatherstoneFurniture>(
        scene.furniture[i], state.furniture[i], scene.world.floor));
    furniture_.back()->addTo(world_);
    wheel_impulse_ns_.emplace_back(scene.furniture[i].wheel_radius_m.size(), 0.0);
  }
}

void FeatherstoneEngine::configureSolver(const StepOptions& options) {
  world_.setGravity(btVector3(0, 0, -kGravity_mps2));
  world_.setForceUpdateAllAabbs(false);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = options.solver_iterations;
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_ARTICULATED_WARMSTARTING | SOLVER_SIMD |
                      SOLVER_USE_2_FRICTION_DIRECTIONS;
}

void FeatherstoneEngine::step(ContactLog& contacts) {
  for (const auto& furniture : furniture_) furniture->applyFriction(step_s_);
  world_.stepSimulation(step_s_, 0);
  readContacts(contacts);
  for (std::size_t i = 0; i < furniture_.size(); ++i) {
    furniture_[i]->updateLoads(wheel_impulse_ns_[i], step_s_);
  }
}

void FeatherstoneEngine::readContacts(ContactLog& contacts) {
  for (std::vector<double>& impulses : wheel_impulse_ns_) {
    std::fill(impulses.begin(), impulses.end(), 0.0);
  }
  btDispatcher& dispatcher = *world_.getDispatcher();
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    if (manifold.getNumContacts() == 0) continue;
    const CollisionTag& a = tagOf(manifold.getBody0());
    const CollisionTag& b = tagOf(manifold.getBody1());
    const bool on_floor =
        a.kind == CollisionTag::Kind::kFloor || b.kind == CollisionTag::Kind::kFloor;
    const CollisionTag& wheel = a.wheel >= 0 ? a : b;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      if (point.m_appliedImpulse <= 0.0) continue;
      if (!on_floor) {
        contacts.add(
            {&a, point.m_index0}, {&b, point.m_index1}, point.m_appliedImpulse,
            toEigen(btVector3(0.5 * (point.getPositionWorldOnA() + point.getPositionWorldOnB()))));
      } else if (wheel.wheel >= 0) {
        wheel_impulse_ns_[static_cast<std::size_t>(wheel.object)]
                         [static_cast<std::size_t>(wheel.wheel)] += point.m_appliedImpulse;
      }
    }
  }
}

}  // namespace casepush::sim
