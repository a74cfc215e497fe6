#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "casepush/common/pose2.h"

namespace casepush::sim {

/// Drives a rigid body's planar velocity towards a target with limited force, solved together with
/// the contacts: what it pushes against pushes back.
///
/// The force limit holds for each axis of the base, as each axis has its own drive.
class PlanarServo final : public btTypedConstraint {
 public:
  /// @param com_p_base_m  Origin of the base frame from the centre of mass; their axes agree.
  /// @param ground  Any static body.
  PlanarServo(btRigidBody& robot, btRigidBody& ground, const btVector3& com_p_base_m,
              double max_force_n, double max_torque_nm);

  void setTarget(const Twist2& robot_twist) { target_ = robot_twist; }

  void getInfo1(btConstraintInfo1* info) override;
  void getInfo2(btConstraintInfo2* info) override;
  void setParam(int, btScalar, int) override {}
  btScalar getParam(int, int) const override { return 0.0; }

 private:
  btVector3 com_p_base_m_;
  double max_force_n_;
  double max_torque_nm_;
  Twist2 target_;
};

}  // namespace casepush::sim
