#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include <memory>
#include <vector>

#include "scene.h"

namespace casepush::sim {

const CollisionTag& tagOf(const btCollisionObject* object);

/// What Bullet needs to find contacts, and the world's static boxes.
class CollisionSpace {
 public:
  explicit CollisionSpace(const Scene& scene);

  void addStatics(btCollisionWorld& world) const;

  btDefaultCollisionConfiguration* configuration() { return configuration_.get(); }
  btCollisionDispatcher& dispatcher() { return dispatcher_; }
  btDbvtBroadphase& broadphase() { return broadphase_; }

 private:
  std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  std::vector<std::unique_ptr<btCollisionObject>> boxes_;
};

}  // namespace casepush::sim
