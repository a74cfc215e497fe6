#include "physics_world.h"

#include <algorithm>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

// A contact this deep at the start is an overlap rather than a touch.
constexpr double kOverlap_m = 0.001;

// Bullet would set aside memory for 4096 contact manifolds, which costs more than all the rest.
std::unique_ptr<btDefaultCollisionConfiguration> makeConfiguration() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 128;
  return std::make_unique<btDefaultCollisionConfiguration>(info);
}

btRigidBody::btRigidBodyConstructionInfo floorInfo(btCollisionShape* shape) {
  btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, shape);
  info.m_friction = 1.0;  // Wheels carry the coefficient of the pair.
  return info;
}

const CollisionTag& tagOf(const btCollisionObject* object) {
  return *static_cast<const CollisionTag*>(object->getUserPointer());
}

struct AnyHit : btCollisionWorld::RayResultCallback {
  bool needsCollision(btBroadphaseProxy* proxy) const override {
    return (proxy->m_collisionFilterGroup & (kStaticGroup | kFurnitureGroup | kWheelGroup)) != 0;
  }
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool) override {
    m_collisionObject = result.m_collisionObject;
    m_closestHitFraction = 0.0;  // Nothing closer can be found: ends the search.
    return 0.0;
  }
};

}  // namespace

PhysicsWorld::PhysicsWorld(const Scene& scene, const WorldState& state, const StepOptions& options)
    : scene_(scene),
      step_s_(options.step_s),
      configuration_(makeConfiguration()),
      dispatcher_(configuration_.get()),
      floor_shape_(btVector3(0, 0, 1), 0.0),
      floor_(floorInfo(&floor_shape_)),
      robot_(scene.robot_blueprint, state.robot, floor_),
      world_(&dispatcher_, &broadphase_, &solver_, configuration_.get()) {
  configureSolver(options);
  addStatics();
  robot_.addTo(world_);
  for (std::size_t i = 0; i < scene.furniture.size(); ++i) {
    furniture_.push_back(
        std::make_unique<Furniture>(scene.furniture[i], state.furniture[i], scene.world.floor));
    furniture_.back()->addTo(world_);
    wheel_impulse_ns_.emplace_back(scene.furniture[i].wheel_radius_m.size(), 0.0);
  }
}

void PhysicsWorld::configureSolver(const StepOptions& options) {
  world_.setGravity(btVector3(0, 0, -kGravity_mps2));
  world_.setForceUpdateAllAabbs(false);
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_numIterations = options.solver_iterations;
  info.m_solverMode = SOLVER_USE_WARMSTARTING | SOLVER_USE_ARTICULATED_WARMSTARTING | SOLVER_SIMD |
                      SOLVER_USE_2_FRICTION_DIRECTIONS;
}

void PhysicsWorld::addStatics() {
  floor_tag_.kind = CollisionTag::Kind::kFloor;
  floor_.setUserPointer(&floor_tag_);
  world_.addRigidBody(&floor_, kFloorGroup, kFurnitureGroup | kWheelGroup);
  for (const StaticBlueprint& blueprint : scene_.boxes) {
    auto box = std::make_unique<btCollisionObject>();
    box->setCollisionShape(blueprint.shape.get());
    box->setWorldTransform(blueprint.map_T_box);
    box->setUserPointer(const_cast<CollisionTag*>(&blueprint.tag));
    box->setActivationState(ISLAND_SLEEPING);
    world_.addCollisionObject(box.get(), kStaticGroup, kFurnitureGroup | kRobotGroup);
    boxes_.push_back(std::move(box));
  }
}

void PhysicsWorld::step(ContactLog& contacts) {
  for (const auto& furniture : furniture_) furniture->applyFriction(step_s_);
  world_.stepSimulation(step_s_, 0);
  readContacts(contacts);
  for (std::size_t i = 0; i < furniture_.size(); ++i) {
    furniture_[i]->updateLoads(wheel_impulse_ns_[i], step_s_);
  }
}

void PhysicsWorld::readContacts(ContactLog& contacts) {
  for (std::vector<double>& impulses : wheel_impulse_ns_) {
    std::fill(impulses.begin(), impulses.end(), 0.0);
  }
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
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
        contacts.add({&a, point.m_index0}, {&b, point.m_index1}, point.m_appliedImpulse);
      } else if (wheel.wheel >= 0) {
        wheel_impulse_ns_[static_cast<std::size_t>(wheel.object)]
                         [static_cast<std::size_t>(wheel.wheel)] += point.m_appliedImpulse;
      }
    }
  }
}

WorldState PhysicsWorld::state() const {
  WorldState state;
  state.robot = robot_.state();
  for (const auto& furniture : furniture_) state.furniture.push_back(furniture->state());
  return state;
}

bool PhysicsWorld::isClear(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map) const {
  AnyHit hit;
  world_.rayTest(toBullet(from_map), toBullet(to_map), hit);
  return !hit.hasHit();
}

std::optional<std::string> PhysicsWorld::findOverlap(const std::vector<std::string>& bodies) {
  world_.performDiscreteCollisionDetection();
  const auto isAsked = [&](const CollisionTag& tag) {
    return std::find(bodies.begin(), bodies.end(), tag.body) != bodies.end();
  };
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    const CollisionTag* a = &tagOf(manifold.getBody0());
    const CollisionTag* b = &tagOf(manifold.getBody1());
    const bool on_floor =
        a->kind == CollisionTag::Kind::kFloor || b->kind == CollisionTag::Kind::kFloor;
    if (on_floor || !(isAsked(*a) || isAsked(*b))) continue;
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      if (point.getDistance() > -kOverlap_m) continue;
      return describeOverlap({a, point.m_index0}, {b, point.m_index1});
    }
  }
  return std::nullopt;
}

}  // namespace casepush::sim
