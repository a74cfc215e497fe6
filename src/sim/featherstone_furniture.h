#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <vector>

#include "casepush/model/world_model.h"
#include "furniture.h"
#include "joint_friction.h"

namespace casepush::sim {

/// A pushable object in Bullet: a Featherstone tree with frictional caster joints.
///
/// Rolling resistance is the lever arm f of the wheel's contact: torque f N, with N the load that
/// the floor carried in the last steps.
class FeatherstoneFurniture final : public Furniture {
 public:
  FeatherstoneFurniture(const FurnitureBlueprint& blueprint, const FurnitureState& state,
                        const Floor& floor);

  void addTo(btMultiBodyDynamicsWorld& world);

  /// Before each step: lets the joints resist under the present wheel loads.
  void applyFriction(double step_s);
  /// After each step: the impulses that the floor gave, in the order of the casters.
  void updateLoads(const std::vector<double>& wheel_impulse_ns, double step_s);

  FurnitureState state() const override;
  Eigen::Isometry3d map_T_root() const override;
  Twist2 twist() const override;
  std::vector<Eigen::Isometry3d> map_T_links() const override;
  double mechanicalEnergyJ() const override;
  const std::vector<double>& wheelLoadN() const override { return wheel_load_n_; }

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
