#include "planar_engine.h"

#include <algorithm>
#include <cmath>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

// Share of a penetration that one step removes, as in Bullet.
constexpr double kPenetrationShare = 0.2;
// A contact whose normal is steeper bears weight and cannot stop motion in the plane.
constexpr double kSteepestNormal = 0.1;
constexpr double kSamePlace_m = 1e-3;
constexpr double kSameNormal = 0.9999;

}  // namespace

PlanarEngine::PlanarEngine(const Scene& scene, CollisionSpace& space, const WorldState& state,
                           const StepOptions& options)
    : step_s_(options.step_s),
      iterations_(options.solver_iterations),
      robot_(scene.robot_blueprint, state.robot),
      awake_(scene.furniture.size(), 1),
      world_(&space.dispatcher(), &space.broadphase(), space.configuration()) {
  world_.setForceUpdateAllAabbs(false);
  space.addStatics(world_);
  robot_.addTo(world_);
  for (std::size_t i = 0; i < scene.furniture.size(); ++i) {
    furniture_.push_back(std::make_unique<PlanarFurniture>(scene.furniture[i], state.furniture[i],
                                                           scene.world.floor));
    furniture_.back()->addTo(world_);
  }
}

void PlanarEngine::step(ContactLog& contacts) {
  world_.performDiscreteCollisionDetection();
  findTouches();
  enterBodies();
  for (const Touch& touch : touches_) addContact(touch);
  solver_.solve(iterations_);
  readContacts(contacts);
  robot_.leave(step_s_, solver_);
  for (std::size_t i = 0; i < furniture_.size(); ++i) {
    if (awake_[i]) furniture_[i]->leave(step_s_, solver_);
  }
}

void PlanarEngine::findTouches() {
  touches_.clear();
  // Furniture at rest that nothing touches stays at rest: no force acts along a level floor.
  for (std::size_t i = 0; i < furniture_.size(); ++i) {
    awake_[i] = !furniture_[i]->body().isAtRest();
  }
  btDispatcher& dispatcher = *world_.getDispatcher();
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      btManifoldPoint& point = manifold.getContactPoint(i);
      const bool steep =
          std::hypot(point.m_normalWorldOnB.x(), point.m_normalWorldOnB.y()) < kSteepestNormal;
      if (steep || point.getDistance() > kContactRange_m) {
        point.m_appliedImpulse = point.m_appliedImpulseLateral1 = 0.0;
        continue;
      }
      addTouch(manifold, point);
    }
  }
}

// Faces that meet touch at a top and a bottom edge: one contact in the plane.
void PlanarEngine::addTouch(btPersistentManifold& manifold, btManifoldPoint& point) {
  const Vector3d map_point =
      0.5 * (toEigen(point.getPositionWorldOnA()) + toEigen(point.getPositionWorldOnB()));
  for (auto touch = touches_.rbegin(); touch != touches_.rend(); ++touch) {
    if (touch->a != manifold.getBody0() || touch->b != manifold.getBody1()) break;
    const btManifoldPoint& other = *touch->point;
    const bool same = (map_point.head<2>() - touch->map_point).norm() < kSamePlace_m &&
                      point.m_normalWorldOnB.dot(other.m_normalWorldOnB) > kSameNormal &&
                      point.m_index0 == other.m_index0 && point.m_index1 == other.m_index1;
    if (!same) continue;
    touch->point->m_distance1 = std::min(other.m_distance1, point.m_distance1);
    touch->point->m_appliedImpulse += point.m_appliedImpulse;
    touch->point->m_appliedImpulseLateral1 += point.m_appliedImpulseLateral1;
    point.m_appliedImpulse = point.m_appliedImpulseLateral1 = 0.0;
    touch->low_m = std::min(touch->low_m, map_point.z());
    touch->high_m = std::max(touch->high_m, map_point.z());
    return;
  }
  touches_.push_back({manifold.getBody0(), manifold.getBody1(), &point, map_point.head<2>(),
                      map_point.z(), map_point.z()});
  wake(manifold.getBody0());
  wake(manifold.getBody1());
}

void PlanarEngine::wake(const btCollisionObject* object) {
  const CollisionTag& tag = tagOf(object);
  if (tag.object >= 0) awake_[static_cast<std::size_t>(tag.object)] = 1;
}

void PlanarEngine::enterBodies() {
  solver_.clear();
  robot_.enter(step_s_, solver_);
  for (std::size_t i = 0; i < furniture_.size(); ++i) {
    if (awake_[i]) furniture_[i]->enter(step_s_, solver_);
  }
}

PlanarFurniture* PlanarEngine::furnitureOf(const btCollisionObject* object) const {
  const CollisionTag& tag = tagOf(object);
  return tag.object < 0 ? nullptr : furniture_[static_cast<std::size_t>(tag.object)].get();
}

void PlanarEngine::setSide(const btCollisionObject* object, const Vector2d& map_point,
                           const Vector2d& normal, PlanarAddress& address, Vector4d& along,
                           Vector4d& across) const {
  along.setZero();
  across.setZero();
  const PlanarFurniture* furniture = furnitureOf(object);
  const bool is_robot = tagOf(object).kind == CollisionTag::Kind::kRobot;
  if (furniture == nullptr && !is_robot) return;
  const PlanarBody& body = is_robot ? robot_.body() : furniture->body();
  const int swivel = is_robot ? -1 : furniture->swivelOf(object->getUserIndex());
  Vector2d point = map_point - body.position();
  if (swivel >= 0) point -= body.pivot(swivel);
  const Vector2d left = Vector2d(-normal.y(), normal.x()).normalized();
  address = body.address(swivel);
  along = body.coordinates(body.direction(point, normal, swivel));
  across = body.coordinates(body.direction(point, left, swivel));
}

void PlanarEngine::addContact(const Touch& touch) {
  const btManifoldPoint& point = *touch.point;
  const Vector2d normal(point.m_normalWorldOnB.x(), point.m_normalWorldOnB.y());
  PlanarContact contact;
  setSide(touch.a, touch.map_point, normal, contact.a, contact.normal_a, contact.across_a);
  setSide(touch.b, touch.map_point, -normal, contact.b, contact.normal_b, contact.across_b);
  const double distance_m = point.getDistance();
  contact.target = -distance_m / step_s_ * (distance_m < 0.0 ? kPenetrationShare : 1.0);
  contact.friction = point.m_combinedFriction;
  contact.normal_impulse = point.m_appliedImpulse;
  contact.across_impulse = point.m_appliedImpulseLateral1;
  solver_.add(contact);
}

void PlanarEngine::readContacts(ContactLog& contacts) {
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const Touch& touch = touches_[i];
    const PlanarContact& contact = solver_.contacts()[i];
    btManifoldPoint& point = *touch.point;
    point.m_appliedImpulse = contact.normal_impulse;
    point.m_appliedImpulseLateral1 = contact.across_impulse;
    if (contact.normal_impulse <= 0.0) continue;
    contacts.add({&tagOf(touch.a), point.m_index0}, {&tagOf(touch.b), point.m_index1},
                 contact.normal_impulse, touch.middle());
    const Vector3d normal = toEigen(point.m_normalWorldOnB);
    const Vector3d left = Vector3d(-normal.y(), normal.x(), 0.0).normalized();
    const Vector3d impulse = contact.normal_impulse * normal + contact.across_impulse * left;
    PlanarTouch planar{touch.map_point, touch.low_m, touch.high_m, impulse};
    if (PlanarFurniture* a = furnitureOf(touch.a)) a->noteTouch(planar);
    planar.impulse_ns = -impulse;
    if (PlanarFurniture* b = furnitureOf(touch.b)) b->noteTouch(planar);
  }
}

}  // namespace casepush::sim
