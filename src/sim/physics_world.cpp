#include "physics_world.h"

#include <algorithm>

#include "featherstone_engine.h"
#include "planar_engine.h"

namespace casepush::sim {
namespace {

// A contact this deep at the start is an overlap rather than a touch.
constexpr double kOverlap_m = 0.001;

std::unique_ptr<Engine> makeEngine(const Scene& scene, CollisionSpace& space,
                                   const WorldState& state, const StepOptions& options) {
  if (options.caster_model == CasterModel::kPlanar) {
    return std::make_unique<PlanarEngine>(scene, space, state, options);
  }
  return std::make_unique<FeatherstoneEngine>(scene, space, state, options);
}

}  // namespace

PhysicsWorld::PhysicsWorld(const Scene& scene, const WorldState& state, const StepOptions& options)
    : scene_(scene), space_(scene), engine_(makeEngine(scene, space_, state, options)) {}

WorldState PhysicsWorld::state() const {
  WorldState state;
  state.robot = robot().state();
  for (std::size_t i = 0; i < scene_.furniture.size(); ++i) {
    state.furniture.push_back(furniture(static_cast<int>(i)).state());
  }
  return state;
}

std::optional<std::string> PhysicsWorld::findOverlap(const std::vector<std::string>& bodies) {
  engine_->collisions().performDiscreteCollisionDetection();
  const auto isAsked = [&](const CollisionTag& tag) {
    return std::find(bodies.begin(), bodies.end(), tag.body) != bodies.end();
  };
  for (int m = 0; m < space_.dispatcher().getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *space_.dispatcher().getManifoldByIndexInternal(m);
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
