#include "planar_servo.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace casepush::sim {
namespace {

void setVector(btScalar* destination, const btVector3& v) {
  for (int i = 0; i < 3; ++i) destination[i] = v[i];
}

}  // namespace

PlanarServo::PlanarServo(btRigidBody& robot, btRigidBody& ground, const btVector3& com_p_base_m,
                         double max_force_n, double max_torque_nm)
    : btTypedConstraint(D6_CONSTRAINT_TYPE, robot, ground),
      com_p_base_m_(com_p_base_m),
      max_force_n_(max_force_n),
      max_torque_nm_(max_torque_nm) {}

void PlanarServo::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = 3;
  info->nub = 3;
}

void PlanarServo::getInfo2(btConstraintInfo2* info) {
  const btMatrix3x3& map_R_base = getRigidBodyA().getWorldTransform().getBasis();
  const btVector3 arm = map_R_base * com_p_base_m_;
  const double targets[] = {target_.vx_mps, target_.vy_mps, target_.wz_rps};
  const double step_s = 1.0 / info->fps;
  for (int row = 0; row < 3; ++row) {
    const int i = row * info->rowskip;
    const btVector3 axis = map_R_base.getColumn(row);
    if (row < 2) {
      setVector(info->m_J1linearAxis + i, axis);
      setVector(info->m_J1angularAxis + i, arm.cross(axis));
    } else {
      setVector(info->m_J1angularAxis + i, axis);
    }
    const double limit = (row < 2 ? max_force_n_ : max_torque_nm_) * step_s;
    info->m_constraintError[i] = targets[row];
    info->m_lowerLimit[i] = -limit;
    info->m_upperLimit[i] = limit;
  }
}

}  // namespace casepush::sim
