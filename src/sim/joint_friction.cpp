#include "joint_friction.h"

namespace casepush::sim {

JointFriction::JointFriction(btMultiBody* body, int link, const btCollisionObject* collider)
    : btMultiBodyConstraint(body, nullptr, link, -1, 1, false,
                            MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR),
      collider_(collider) {
  m_maxAppliedImpulse = 0.0;
}

void JointFriction::finalizeMultiDof() {
  allocateJacobiansMultiDof();
  jacobianA(0)[6 + m_bodyA->getLink(m_linkA).m_dofOffset] = 1.0;
  m_numDofsFinalized = m_jacSizeBoth;
}

void JointFriction::createConstraintRows(btMultiBodyConstraintArray& rows,
                                         btMultiBodyJacobianData& data,
                                         const btContactSolverInfo& info) {
  if (m_numDofsFinalized != m_jacSizeBoth) finalizeMultiDof();
  if (m_maxAppliedImpulse <= 0.0) return;
  const btVector3 zero(0, 0, 0);
  btMultiBodySolverConstraint& row = rows.expandNonInitializing();
  row.m_orgConstraint = this;
  row.m_orgDofIndex = 0;
  row.m_solverBodyIdA = -1;
  row.m_solverBodyIdB = data.m_fixedBodyId;
  fillMultiBodyConstraint(row, data, jacobianA(0), nullptr, zero, zero, zero, zero, 0.0, info,
                          -m_maxAppliedImpulse, m_maxAppliedImpulse);
  row.m_solverBodyIdB = -1;  // Spares the solver the fixed body.
  row.m_contactNormal1 = row.m_contactNormal2 = zero;
  row.m_relpos1CrossNormal = row.m_relpos2CrossNormal = zero;
}

}  // namespace casepush::sim
