#include "collision_space.h"

namespace casepush::sim {
namespace {

// Of walls and other static boxes.
constexpr double kBoxFriction = 0.5;

// Bullet would set aside memory for 4096 contact manifolds, which costs more than all the rest.
std::unique_ptr<btDefaultCollisionConfiguration> makeConfiguration() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 128;
  return std::make_unique<btDefaultCollisionConfiguration>(info);
}

}  // namespace

const CollisionTag& tagOf(const btCollisionObject* object) {
  return *static_cast<const CollisionTag*>(object->getUserPointer());
}

CollisionSpace::CollisionSpace(const Scene& scene)
    : configuration_(makeConfiguration()), dispatcher_(configuration_.get()) {
  for (const StaticBlueprint& blueprint : scene.boxes) {
    auto box = std::make_unique<btCollisionObject>();
    box->setCollisionShape(blueprint.shape.get());
    box->setWorldTransform(blueprint.map_T_box);
    box->setFriction(kBoxFriction);
    box->setUserPointer(const_cast<CollisionTag*>(&blueprint.tag));
    box->setActivationState(ISLAND_SLEEPING);
    boxes_.push_back(std::move(box));
  }
}

void CollisionSpace::addStatics(btCollisionWorld& world) const {
  for (const auto& box : boxes_) {
    world.addCollisionObject(box.get(), kStaticGroup, kFurnitureGroup | kRobotGroup);
  }
}

}  // namespace casepush::sim
