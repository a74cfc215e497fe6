#include "planar_furniture.h"

#include <cmath>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d planar(const btVector3& v) { return {v.x(), v.y()}; }

// What a rotation adds to the velocity of a point at `arm` from the one that is known.
Vector2d swung(double yaw_rate, const Vector2d& arm) {
  return yaw_rate * Vector2d(-arm.y(), arm.x());
}

}  // namespace

PlanarFurniture::PlanarFurniture(const FurnitureBlueprint& blueprint, const FurnitureState& state,
                                 const Floor& floor)
    : blueprint_(blueprint),
      model_(makePlanarModel(blueprint)),
      body_(model_.chassis_mass_kg, model_.chassis_inertia_kgm2, model_.swivels),
      supports_(model_, floor),
      swivel_of_joint_(state.joint_rad.size(), -1),
      wheel_of_joint_(state.joint_rad.size(), -1) {
  for (std::size_t i = 0; i < model_.swivels.size(); ++i) {
    swivel_of_joint_[static_cast<std::size_t>(model_.swivels[i].joint)] = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < model_.wheels.size(); ++i) {
    wheel_of_joint_[static_cast<std::size_t>(model_.wheels[i].joint)] = static_cast<int>(i);
  }
  setState(state);
  setupColliders(floor);
}

void PlanarFurniture::setState(const FurnitureState& state) {
  const Pose2 map_T_object = toPlanar(toEigen(state.map_T_base) * blueprint_.com_T_link[0]);
  const double yaw_rate = state.base_omega_rps.z();
  const Vector2d map_p_com = map_T_object * model_.root_p_com;
  const Vector2d arm = map_p_com - planar(state.map_T_base.getOrigin());
  body_.setPose(map_p_com, map_T_object.yaw());
  body_.setVelocity(planar(state.base_velocity_mps) + swung(yaw_rate, arm), yaw_rate);
  for (std::size_t i = 0; i < model_.swivels.size(); ++i) {
    const PlanarSwivel& swivel = model_.swivels[i];
    const auto joint = static_cast<std::size_t>(swivel.joint);
    body_.setSwivel(static_cast<int>(i), body_.yaw() + swivel.sense * state.joint_rad[joint],
                    yaw_rate + swivel.sense * state.joint_rps[joint]);
  }
  for (std::size_t i = 0; i < model_.wheels.size(); ++i) {
    const auto joint = static_cast<std::size_t>(model_.wheels[i].joint);
    supports_.setSpin(static_cast<int>(i), state.joint_rad[joint], state.joint_rps[joint]);
  }
  supports_.setLoads(state.wheel_load_n);
  if (!body_.isAtRest()) return;
  body_.beginStep();
  supports_.addMass(body_);
  supports_.settle(body_);
}

void PlanarFurniture::setupColliders(const Floor& floor) {
  for (std::size_t b = 0; b < blueprint_.bodies.size(); ++b) {
    const BodyBlueprint& body = blueprint_.bodies[b];
    if (body.shape == nullptr || body.wheel >= 0) continue;
    auto object = std::make_unique<btCollisionObject>();
    object->setCollisionFlags(0);  // Bullet takes a plain object for a static one.
    object->setCollisionShape(body.shape);
    object->setUserPointer(const_cast<CollisionTag*>(&body.tag));
    object->setFriction(surfaceFriction(blueprint_, body, floor));
    object->setActivationState(DISABLE_DEACTIVATION);
    for (const Collider& other : colliders_) {
      object->setIgnoreCollisionCheck(other.object.get(), true);
      other.object->setIgnoreCollisionCheck(object.get(), true);
    }
    object->setUserIndex(static_cast<int>(b));
    colliders_.push_back({static_cast<int>(b), std::move(object)});
  }
  placeColliders();
}

void PlanarFurniture::placeColliders() {
  for (const Collider& collider : colliders_) {
    const MassProperties& mass = blueprint_.bodies[static_cast<std::size_t>(collider.body)].mass;
    collider.object->setWorldTransform(toBullet(map_T_turned(collider.body) * mass.root_T_com));
  }
}

void PlanarFurniture::addTo(btCollisionWorld& world) {
  for (const Collider& collider : colliders_) {
    world.addCollisionObject(collider.object.get(), kFurnitureGroup,
                             kStaticGroup | kFurnitureGroup | kRobotGroup);
  }
}

void PlanarFurniture::enter(double step_s, PlanarSolver& solver) {
  body_.beginStep();
  supports_.addMass(body_);
  body_.enter(step_s, solver);
  supports_.enter(step_s, body_, solver);
}

void PlanarFurniture::leave(double step_s, PlanarSolver& solver) {
  const Vector2d before_mps = body_.linearVelocity();
  body_.leave(step_s, solver);
  supports_.leave(step_s, body_, body_.linearVelocity() - before_mps, solver);
  placeColliders();
}

int PlanarFurniture::swivelOf(int body) const {
  return body == 0 ? -1 : swivel_of_joint_[static_cast<std::size_t>(body) - 1];
}

Pose2 PlanarFurniture::map_T_object() const {
  const Pose2 turn(0.0, 0.0, body_.yaw());
  const Vector2d origin = body_.position() - turn * model_.root_p_com;
  return {origin.x(), origin.y(), body_.yaw()};
}

Isometry3d PlanarFurniture::map_T_root() const { return toSpatial(map_T_object()); }

Twist2 PlanarFurniture::twist() const {
  const Pose2 pose = map_T_object();
  const Vector2d velocity =
      body_.linearVelocity() + swung(body_.yawRate(), pose.position() - body_.position());
  return rotate({velocity.x(), velocity.y(), body_.yawRate()}, -pose.yaw());
}

double PlanarFurniture::jointRad(int joint) const {
  const int swivel = swivel_of_joint_[static_cast<std::size_t>(joint)];
  if (swivel < 0) return supports_.spinRad(wheel_of_joint_[static_cast<std::size_t>(joint)]);
  const double sense = model_.swivels[static_cast<std::size_t>(swivel)].sense;
  return sense * (body_.heading(swivel) - body_.yaw());
}

double PlanarFurniture::jointRps(int joint) const {
  const int swivel = swivel_of_joint_[static_cast<std::size_t>(joint)];
  if (swivel < 0) return supports_.spinRps(wheel_of_joint_[static_cast<std::size_t>(joint)]);
  const double sense = model_.swivels[static_cast<std::size_t>(swivel)].sense;
  return sense * (body_.headingRate(swivel) - body_.yawRate());
}

Isometry3d PlanarFurniture::map_T_turned(int body) const {
  if (body == 0) return map_T_root();
  const BodyBlueprint& blueprint = blueprint_.bodies[static_cast<std::size_t>(body)];
  const Eigen::Translation3d pivot(blueprint.root_pivot_m);
  return map_T_turned(blueprint.parent) * pivot *
         Eigen::AngleAxisd(jointRad(body - 1), blueprint.root_axis) * pivot.inverse();
}

std::vector<Isometry3d> PlanarFurniture::map_T_links() const {
  std::vector<Isometry3d> poses;
  poses.reserve(blueprint_.body_of_link.size());
  for (std::size_t i = 0; i < blueprint_.body_of_link.size(); ++i) {
    const int body = blueprint_.body_of_link[i];
    const MassProperties& mass = blueprint_.bodies[static_cast<std::size_t>(body)].mass;
    poses.push_back(map_T_turned(body) * mass.root_T_com * blueprint_.com_T_link[i]);
  }
  return poses;
}

FurnitureState PlanarFurniture::state() const {
  FurnitureState state;
  const Isometry3d map_T_base = map_T_root() * blueprint_.bodies[0].mass.root_T_com;
  const Vector2d arm = map_T_base.translation().head<2>() - body_.position();
  const Vector2d velocity = body_.linearVelocity() + swung(body_.yawRate(), arm);
  state.map_T_base = toBullet(map_T_base);
  state.base_velocity_mps = btVector3(velocity.x(), velocity.y(), 0.0);
  state.base_omega_rps = btVector3(0.0, 0.0, body_.yawRate());
  for (int joint = 0; joint < static_cast<int>(swivel_of_joint_.size()); ++joint) {
    state.joint_rad.push_back(jointRad(joint));
    state.joint_rps.push_back(jointRps(joint));
  }
  if (!model_.wheels.empty()) state.wheel_load_n = supports_.loadN();
  return state;
}

double PlanarFurniture::mechanicalEnergyJ() const {
  return body_.kineticEnergyJ() + supports_.spinEnergyJ() +
         model_.mass_kg * kGravity_mps2 * model_.com_height_m;
}

}  // namespace casepush::sim
