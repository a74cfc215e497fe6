#include "sight.h"

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

struct AnyHit : btCollisionWorld::RayResultCallback {
  bool needsCollision(btBroadphaseProxy* proxy) const override {
    return (proxy->m_collisionFilterGroup & (kStaticGroup | kFurnitureGroup)) != 0;
  }
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool) override {
    m_collisionObject = result.m_collisionObject;
    m_closestHitFraction = 0.0;  // Nothing closer can be found: ends the search.
    return 0.0;
  }
};

struct NearestHit : btCollisionWorld::RayResultCallback {
  bool needsCollision(btBroadphaseProxy*) const override { return true; }
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool) override {
    m_collisionObject = result.m_collisionObject;
    m_closestHitFraction = result.m_hitFraction;
    return m_closestHitFraction;
  }
};

}  // namespace

Sight::Sight(const Scene& scene)
    : space_(scene), world_(&space_.dispatcher(), &space_.broadphase(), space_.configuration()) {
  space_.addStatics(world_);
  for (const FurnitureBlueprint& furniture : scene.furniture) {
    Links& links = furniture_.emplace_back();
    const std::vector<casepush::Link>& models = furniture.model->mechanism.links;
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (models[i].collision.empty()) continue;
      links.push_back(std::make_unique<Link>());
      links.back()->index = static_cast<int>(i);
      for (const PlacedShape& shape : models[i].collision) {
        links.back()->shape.add(shape, Eigen::Isometry3d::Identity());
      }
      add(*links.back(), kFurnitureGroup);
    }
  }
  for (const PlacedShape& shape : scene.robot.solid) {
    robot_.shape.add(shape, Eigen::Isometry3d::Identity());
  }
  add(robot_, kRobotGroup);
}

void Sight::add(Link& link, int group) {
  link.object.setCollisionShape(link.shape.get());
  world_.addCollisionObject(&link.object, group, 0);
}

void Sight::look(const PhysicsWorld& physics) {
  const auto place = [this](Link& link, const Eigen::Isometry3d& map_T_link) {
    link.object.setWorldTransform(toBullet(map_T_link));
    world_.updateSingleAabb(&link.object);
  };
  for (std::size_t i = 0; i < furniture_.size(); ++i) {
    const std::vector<Eigen::Isometry3d> poses =
        physics.furniture(static_cast<int>(i)).map_T_links();
    for (const auto& link : furniture_[i]) {
      place(*link, poses[static_cast<std::size_t>(link->index)]);
    }
  }
  place(robot_, toSpatial(physics.robot().pose()));
}

bool Sight::isClear(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map) const {
  AnyHit hit;
  world_.rayTest(toBullet(from_map), toBullet(to_map), hit);
  return !hit.hasHit();
}

Sight::Hit Sight::cast(const Eigen::Vector3d& from_map, const Eigen::Vector3d& direction_map,
                       double max_range_m) const {
  double reach_m = 1.001 * max_range_m;
  if (direction_map.z() < 0.0) reach_m = std::min(reach_m, -from_map.z() / direction_map.z());
  NearestHit hit;
  world_.rayTest(toBullet(from_map), toBullet(Eigen::Vector3d(from_map + reach_m * direction_map)),
                 hit);
  return {reach_m * hit.m_closestHitFraction, hit.m_collisionObject == &robot_.object};
}

}  // namespace casepush::sim
