#include "planar_robot.h"

#include <cmath>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

using Eigen::Vector2d;

const std::vector<PlanarSwivel> kNoSwivels;

}  // namespace

PlanarRobot::PlanarRobot(const RobotBlueprint& blueprint, const RobotState& state)
    : blueprint_(blueprint),
      body_(blueprint.mass.mass_kg, blueprint.mass.rootInertia()(2, 2), kNoSwivels) {
  const Eigen::Isometry3d map_T_com = toEigen(state.map_T_com);
  const Pose2 pose = toPlanar(map_T_com);
  body_.setPose(pose.position(), pose.yaw());
  body_.setVelocity({state.velocity_mps.x(), state.velocity_mps.y()}, state.omega_rps.z());
  collider_.setCollisionFlags(0);  // Bullet takes a plain object for a static one.
  collider_.setCollisionShape(blueprint.shape.get());
  collider_.setUserPointer(const_cast<CollisionTag*>(&blueprint.tag));
  collider_.setFriction(blueprint.surface_friction);
  collider_.setActivationState(DISABLE_DEACTIVATION);
  placeCollider();
}

void PlanarRobot::addTo(btCollisionWorld& world) {
  world.addCollisionObject(&collider_, kRobotGroup, kStaticGroup | kFurnitureGroup);
}

void PlanarRobot::placeCollider() { collider_.setWorldTransform(state().map_T_com); }

void PlanarRobot::enter(double step_s, PlanarSolver& solver) {
  body_.beginStep();
  body_.enter(step_s, solver);
  first_drive_ = solver.drives().size();
  const Vector2d arm = body_.turned(-blueprint_.base_T_com.translation().head<2>(), -1);
  const double targets[] = {target_.vx_mps, target_.vy_mps, target_.wz_rps};
  const double limits[] = {blueprint_.limits.max_force_n, blueprint_.limits.max_force_n,
                           blueprint_.limits.max_torque_nm};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    PlanarDirection direction;
    if (axis < 2) {
      direction =
          body_.direction(arm, body_.turned(Vector2d::Unit(static_cast<int>(axis)), -1), -1);
    } else {
      direction.chassis = Eigen::Vector3d::UnitZ();
    }
    PlanarDrive drive;
    drive.at = body_.address(-1);
    drive.row.j = body_.coordinates(direction);
    drive.row.target = targets[axis];
    drive.row.limit = limits[axis] * step_s;
    drive.row.impulse = impulse_ns_[axis];
    solver.add(drive);
  }
}

void PlanarRobot::leave(double step_s, PlanarSolver& solver) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    impulse_ns_[axis] = solver.drives()[first_drive_ + axis].row.impulse;
  }
  body_.leave(step_s, solver);
  placeCollider();
}

RobotState PlanarRobot::state() const {
  RobotState state;
  Eigen::Isometry3d map_T_com =
      toSpatial(Pose2(body_.position().x(), body_.position().y(), body_.yaw()));
  map_T_com.translation().z() = blueprint_.base_T_com.translation().z();
  state.map_T_com = toBullet(map_T_com);
  state.velocity_mps = btVector3(body_.linearVelocity().x(), body_.linearVelocity().y(), 0.0);
  state.omega_rps = btVector3(0.0, 0.0, body_.yawRate());
  return state;
}

Pose2 PlanarRobot::pose() const {
  const Pose2 map_T_com(body_.position().x(), body_.position().y(), body_.yaw());
  const Vector2d base_p_com = blueprint_.base_T_com.translation().head<2>();
  return map_T_com * Pose2(-base_p_com.x(), -base_p_com.y(), 0.0);
}

Twist2 PlanarRobot::twist() const {
  const Vector2d arm = pose().position() - body_.position();
  const Vector2d velocity = body_.linearVelocity() + body_.yawRate() * Vector2d(-arm.y(), arm.x());
  return rotate({velocity.x(), velocity.y(), body_.yawRate()}, -pose().yaw());
}

}  // namespace casepush::sim
