#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

namespace casepush::sim {

/// Coulomb friction of a revolute joint: a motor that wants zero velocity with a bounded impulse.
///
/// As btMultiBodyJointMotor, but with one body instead of the same one twice, which halves its
/// cost, and without the need of a collider on the link.
class JointFriction final : public btMultiBodyConstraint {
 public:
  JointFriction(btMultiBody* body, int link, const btCollisionObject* collider);

  int getIslandIdA() const override { return collider_->getIslandTag(); }
  int getIslandIdB() const override { return -1; }
  void finalizeMultiDof() override;
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  void debugDraw(btIDebugDraw*) override {}

 private:
  const btCollisionObject* collider_;  // Any collider of the body: tells the simulation island.
};

}  // namespace casepush::sim
