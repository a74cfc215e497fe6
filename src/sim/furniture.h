#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/common/random.h"
#include "casepush/model/world_model.h"
#include "furniture_blueprint.h"
#include "joint_friction.h"

namespace casepush::sim {

constexpr double kGravity_mps2 = 9.81;

/// All of an object that moves. Vectors are indexed by body - 1 and by caster.
struct FurnitureState {
  btTransform map_T_base = btTransform::getIdentity();  ///< Base: centre of mass of body 0.
  btVector3 base_velocity_mps{0, 0, 0};
  btVector3 base_omega_rps{0, 0, 0};
  std::vector<double> joint_rad;
  std::vector<double> joint_rps;
  std::vector<double> wheel_load_n;
};

/// Standing still with swivels drawn at random.
FurnitureState stateAtRest(const FurnitureBlueprint& blueprint, const Pose2& map_T_object,
                           Random& random);

/// A pushable object in Bullet: a Featherstone tree with frictional caster joints.
///
/// Rolling resistance is the lever arm f of the wheel's contact: torque f N, with N the load that
/// the floor carried in the last steps.
class Furniture {
 public:
  Furniture(const FurnitureBlueprint& blueprint, const FurnitureState& state, const Floor& floor);

  void addTo(btMultiBodyDynamicsWorld& world);

  /// Before each step: lets the joints resist under the present wheel loads.
  void applyFriction(double step_s);
  /// After each step: the impulses that the floor gave, in the order of the casters.
  void updateLoads(const std::vector<double>& wheel_impulse_ns, double step_s);

  FurnitureState state() const;
  Eigen::Isometry3d map_T_root() const;
  Twist2 twist() const;  ///< Of the object's origin, in the object frame.
  std::vector<Eigen::Isometry3d> map_T_links() const;
  double mechanicalEnergyJ() const;  ///< Kinetic, and potential above the floor.
  const std::vector<double>& wheelLoadN() const { return wheel_load_n_; }
  const FurnitureBlueprint& blueprint() const { return blueprint_; }

 private:
  void setupLinks();
  void setupColliders(const Floor& floor);
  void setState(const FurnitureState& state);
  btTransform map_T_com(int body) const;

  const FurnitureBlueprint& blueprint_;
  double rolling_lever_arm_m_;
  std::vector<double> wheel_load_n_;
  std::unique_ptr<btMultiBody> body_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<JointFriction>> friction_;  // By body - 1.
};

}  // namespace casepush::sim
