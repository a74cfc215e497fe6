#include "robot_base.h"

#include <numeric>

#include "bullet_conversions.h"
#include "casepush/common/input_error.h"

namespace casepush::sim {

RobotBlueprint makeBlueprint(const RobotModel& robot) {
  RobotBlueprint result;
  result.limits = robot.limits;
  result.surface_friction = robot.surface_friction;
  std::vector<int> links(robot.mechanism.links.size());
  std::iota(links.begin(), links.end(), 0);
  result.mass = composeMass(robot.mechanism, links);
  result.base_T_com.translation() = result.mass.root_T_com.translation();
  for (const PlacedShape& shape : robot.solid) {
    result.shape.add(shape, result.base_T_com.inverse());
  }
  if (result.shape.isEmpty()) throw InputError(robot.name, "has no collision shapes");
  result.tag.kind = CollisionTag::Kind::kRobot;
  result.tag.body = "robot";
  result.tag.parts = result.shape.parts();
  return result;
}

RobotState stateAtRest(const RobotBlueprint& blueprint, const Pose2& map_T_robot) {
  RobotState state;
  state.map_T_com = toBullet(toSpatial(map_T_robot) * blueprint.base_T_com);
  return state;
}

RobotBase::RobotBase(const RobotBlueprint& blueprint, const RobotState& state, btRigidBody& ground)
    : blueprint_(blueprint) {
  // Zero roll and pitch inertia means infinite for Bullet: the base stays in the plane.
  const btVector3 inertia(0, 0, blueprint.mass.rootInertia()(2, 2));
  btRigidBody::btRigidBodyConstructionInfo info(blueprint.mass.mass_kg, nullptr,
                                                blueprint.shape.get(), inertia);
  info.m_startWorldTransform = state.map_T_com;
  info.m_friction = blueprint.surface_friction;
  body_ = std::make_unique<btRigidBody>(info);
  body_->setLinearFactor(btVector3(1, 1, 0));
  body_->setAngularFactor(btVector3(0, 0, 1));
  body_->setLinearVelocity(state.velocity_mps);
  body_->setAngularVelocity(state.omega_rps);
  body_->setDamping(0, 0);
  body_->setContactProcessingThreshold(kContactRange_m);
  body_->setFlags(BT_DISABLE_WORLD_GRAVITY);
  body_->setActivationState(DISABLE_DEACTIVATION);
  body_->setUserPointer(const_cast<CollisionTag*>(&blueprint.tag));
  const Eigen::Vector3d com_p_base = -blueprint.base_T_com.translation();
  servo_ =
      std::make_unique<PlanarServo>(*body_, ground, toBullet(com_p_base),
                                    blueprint.limits.max_force_n, blueprint.limits.max_torque_nm);
}

void RobotBase::addTo(btDiscreteDynamicsWorld& world) {
  world.addRigidBody(body_.get(), kRobotGroup, kStaticGroup | kFurnitureGroup);
  world.addConstraint(servo_.get(), false);
}

RobotState RobotBase::state() const {
  return {body_->getWorldTransform(), body_->getLinearVelocity(), body_->getAngularVelocity()};
}

Pose2 RobotBase::pose() const {
  return toPlanar(toEigen(body_->getWorldTransform()) * blueprint_.base_T_com.inverse());
}

Twist2 RobotBase::twist() const {
  const btVector3 arm = body_->getWorldTransform().getBasis() *
                        -toBullet(Eigen::Vector3d(blueprint_.base_T_com.translation()));
  const btVector3 velocity = body_->getVelocityInLocalPoint(arm);
  return rotate({velocity.x(), velocity.y(), body_->getAngularVelocity().z()}, -pose().yaw());
}

}  // namespace casepush::sim
