#include "featherstone_furniture.h"

#include <cmath>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

// The contact of each wheel as a critically damped spring. Rigid ones would leave it to the
// solver's history which of four or five wheels bear how much; equal springs share the load as
// statics says.
void soften(btCollisionObject& wheel, double share_kg) {
  const double stiffness_npm = share_kg * kGravity_mps2 / kWheelSink_m;
  wheel.setContactStiffnessAndDamping(stiffness_npm, 2.0 * std::sqrt(stiffness_npm * share_kg));
}

}  // namespace

FeatherstoneFurniture::FeatherstoneFurniture(const FurnitureBlueprint& blueprint,
                                             const FurnitureState& state, const Floor& floor)
    : blueprint_(blueprint), rolling_lever_arm_m_(floor.rolling_lever_arm_m) {
  const BodyBlueprint& base = blueprint.bodies[0];
  const int links = static_cast<int>(blueprint.bodies.size()) - 1;
  body_ = std::make_unique<btMultiBody>(links, base.mass.mass_kg, toBullet(base.mass.inertia_kgm2),
                                        false, false);
  body_->setLinearDamping(0.0);
  body_->setAngularDamping(0.0);
  body_->setHasSelfCollision(false);
  setupLinks();
  body_->finalizeMultiDof();
  setState(state);
  setupColliders(floor);
  for (int i = 0; i < links; ++i) {
    friction_.push_back(std::make_unique<JointFriction>(body_.get(), i, colliders_[0].get()));
    friction_.back()->finalizeMultiDof();
  }
}

void FeatherstoneFurniture::setupLinks() {
  for (std::size_t b = 1; b < blueprint_.bodies.size(); ++b) {
    const BodyBlueprint& body = blueprint_.bodies[b];
    const Eigen::Isometry3d& root_T_this = body.mass.root_T_com;
    const Eigen::Isometry3d& root_T_parent =
        blueprint_.bodies[static_cast<std::size_t>(body.parent)].mass.root_T_com;
    const Eigen::Matrix3d this_R_root = root_T_this.linear().transpose();
    btQuaternion this_R_parent;
    toBullet(Eigen::Matrix3d(this_R_root * root_T_parent.linear())).getRotation(this_R_parent);
    const Eigen::Vector3d parent_p_pivot = root_T_parent.inverse() * body.root_pivot_m;
    const Eigen::Vector3d this_pivot_to_com =
        this_R_root * (root_T_this.translation() - body.root_pivot_m);
    body_->setupRevolute(static_cast<int>(b) - 1, body.mass.mass_kg,
                         toBullet(body.mass.inertia_kgm2), body.parent - 1, this_R_parent,
                         toBullet(Eigen::Vector3d(this_R_root * body.root_axis)),
                         toBullet(parent_p_pivot), toBullet(this_pivot_to_com), true);
  }
}

void FeatherstoneFurniture::setupColliders(const Floor& floor) {
  const auto wheels = static_cast<double>(blueprint_.wheel_radius_m.size());
  for (std::size_t b = 0; b < blueprint_.bodies.size(); ++b) {
    const BodyBlueprint& body = blueprint_.bodies[b];
    if (body.shape == nullptr) continue;
    const int link = static_cast<int>(b) - 1;
    auto collider = std::make_unique<btMultiBodyLinkCollider>(body_.get(), link);
    collider->setCollisionShape(body.shape);
    collider->setUserPointer(const_cast<CollisionTag*>(&body.tag));
    collider->setFriction(surfaceFriction(blueprint_, body, floor));
    collider->setRestitution(0.0);
    if (body.wheel >= 0) soften(*collider, blueprint_.mass_kg / wheels);
    collider->setContactProcessingThreshold(kContactRange_m);
    collider->setActivationState(DISABLE_DEACTIVATION);
    if (link < 0) {
      body_->setBaseCollider(collider.get());
    } else {
      body_->getLink(link).m_collider = collider.get();
    }
    colliders_.push_back(std::move(collider));
  }
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  body_->forwardKinematics(rotations, origins);
  body_->updateCollisionObjectWorldTransforms(rotations, origins);
}

void FeatherstoneFurniture::addTo(btMultiBodyDynamicsWorld& world) {
  world.addMultiBody(body_.get());
  for (const auto& collider : colliders_) {
    const auto& tag = *static_cast<const CollisionTag*>(collider->getUserPointer());
    if (tag.kind == CollisionTag::Kind::kWheel) {
      world.addCollisionObject(collider.get(), kWheelGroup, kFloorGroup);
    } else {
      // A fork would only ever graze the floor; the base keeps a tipped object above it.
      const int floor = collider->m_link < 0 ? static_cast<int>(kFloorGroup) : 0;
      world.addCollisionObject(collider.get(), kFurnitureGroup,
                               kStaticGroup | kFurnitureGroup | kRobotGroup | floor);
    }
  }
  for (const auto& friction : friction_) world.addMultiBodyConstraint(friction.get());
}

void FeatherstoneFurniture::applyFriction(double step_s) {
  for (std::size_t b = 1; b < blueprint_.bodies.size(); ++b) {
    const BodyBlueprint& body = blueprint_.bodies[b];
    double torque_nm = body.friction_nm;
    if (body.wheel >= 0) {
      torque_nm += rolling_lever_arm_m_ * wheel_load_n_[static_cast<std::size_t>(body.wheel)];
    }
    friction_[b - 1]->setMaxAppliedImpulse(torque_nm * step_s);
  }
}

void FeatherstoneFurniture::updateLoads(const std::vector<double>& wheel_impulse_ns,
                                        double step_s) {
  const double gain = -std::expm1(-step_s / kLoadSmoothing_s);
  for (std::size_t i = 0; i < wheel_load_n_.size(); ++i) {
    wheel_load_n_[i] += gain * (wheel_impulse_ns[i] / step_s - wheel_load_n_[i]);
  }
}

void FeatherstoneFurniture::setState(const FurnitureState& state) {
  body_->setBaseWorldTransform(state.map_T_base);
  body_->setBaseVel(state.base_velocity_mps);
  body_->setBaseOmega(state.base_omega_rps);
  for (std::size_t i = 0; i < state.joint_rad.size(); ++i) {
    body_->setJointPos(static_cast<int>(i), state.joint_rad[i]);
    body_->setJointVel(static_cast<int>(i), state.joint_rps[i]);
  }
  wheel_load_n_ = state.wheel_load_n;
}

FurnitureState FeatherstoneFurniture::state() const {
  FurnitureState state;
  state.map_T_base = body_->getBaseWorldTransform();
  state.base_velocity_mps = body_->getBaseVel();
  state.base_omega_rps = body_->getBaseOmega();
  for (int i = 0; i < body_->getNumLinks(); ++i) {
    state.joint_rad.push_back(body_->getJointPos(i));
    state.joint_rps.push_back(body_->getJointVel(i));
  }
  state.wheel_load_n = wheel_load_n_;
  return state;
}

Eigen::Isometry3d FeatherstoneFurniture::map_T_root() const {
  return toEigen(body_->getBaseWorldTransform()) * blueprint_.com_T_link[0];
}

Twist2 FeatherstoneFurniture::twist() const {
  const Eigen::Isometry3d map_T_object = map_T_root();
  const Eigen::Vector3d omega = toEigen(body_->getBaseOmega());
  const Eigen::Vector3d arm = map_T_object.translation() - toEigen(body_->getBasePos());
  const Eigen::Vector3d velocity = toEigen(body_->getBaseVel()) + omega.cross(arm);
  return rotate({velocity.x(), velocity.y(), omega.z()}, -toPlanar(map_T_object).yaw());
}

double FeatherstoneFurniture::mechanicalEnergyJ() const {
  std::vector<btVector3> omega(blueprint_.bodies.size());
  std::vector<btVector3> velocity(blueprint_.bodies.size());
  body_->compTreeLinkVelocities(omega.data(), velocity.data());
  double energy_j = 0.0;
  for (std::size_t b = 0; b < omega.size(); ++b) {
    const MassProperties& mass = blueprint_.bodies[b].mass;
    const double height_m = map_T_com(static_cast<int>(b)).getOrigin().z();
    energy_j += 0.5 * mass.mass_kg * velocity[b].length2() +
                0.5 * omega[b].dot(toBullet(mass.inertia_kgm2) * omega[b]) +
                mass.mass_kg * kGravity_mps2 * height_m;
  }
  return energy_j;
}

btTransform FeatherstoneFurniture::map_T_com(int body) const {
  // The transforms that Bullet keeps of links are those before the last step.
  return btTransform(body_->localFrameToWorld(body - 1, btMatrix3x3::getIdentity()),
                     body_->localPosToWorld(body - 1, btVector3(0, 0, 0)));
}

std::vector<Eigen::Isometry3d> FeatherstoneFurniture::map_T_links() const {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(blueprint_.body_of_link.size());
  for (std::size_t i = 0; i < blueprint_.body_of_link.size(); ++i) {
    const int body = blueprint_.body_of_link[i];
    poses.push_back(toEigen(map_T_com(body)) * blueprint_.com_T_link[i]);
  }
  return poses;
}

}  // namespace casepush::sim
