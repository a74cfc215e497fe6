#include "caster_solver.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace casepush::sim {
namespace {

using Velocities = Eigen::Map<Eigen::VectorXd>;

double squaredVelocity(double impulse, const btMultiBodySolverConstraint& row) {
  if (row.m_jacDiagABInv <= 0.0) return 0.0;
  const double velocity = impulse / row.m_jacDiagABInv;
  return velocity * velocity;
}

}  // namespace

btScalar CasterSolver::solveSingleIteration(int iteration, btCollisionObject** bodies,
                                            int body_count, btPersistentManifold** manifolds,
                                            int manifold_count, btTypedConstraint** constraints,
                                            int constraint_count, const btContactSolverInfo& info,
                                            btIDebugDraw* drawer) {
  if (iteration == 0) noteStart();
  double residual = btSequentialImpulseConstraintSolver::solveSingleIteration(
      iteration, bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info,
      drawer);
  const int joints = m_multiBodyNonContactConstraints.size();
  for (int i = 0; i < joints; ++i) {
    const int k = iteration % 2 == 1 ? i : joints - 1 - i;
    residual = std::max(residual, solveJointRow(m_multiBodyNonContactConstraints[k]));
  }
  for (int i = 0; i < m_multiBodyNormalContactConstraints.size(); ++i) {
    residual = std::max(residual, solveNormalRow(m_multiBodyNormalContactConstraints[i]));
  }
  for (int i = 0; i + 1 < m_multiBodyFrictionContactConstraints.size(); i += 2) {
    const Row& a = m_multiBodyFrictionContactConstraints[i];
    const Row& b = m_multiBodyFrictionContactConstraints[i + 1];
    const double normal = m_multiBodyNormalContactConstraints[a.m_frictionIndex].m_appliedImpulse;
    residual = std::max(residual, solveFrictionRows(a, b, a.m_friction * normal));
  }
  return residual;
}

btScalar CasterSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                                     const btContactSolverInfo& info) {
  for (const auto& [body, index] : bodies_) {
    const int n = body->getNumDofs() + 6;
    Velocities start(&start_velocities_[static_cast<std::size_t>(index)], n);
    start = Velocities(&m_data.m_deltaVelocities[index], n) - start;
    body->applyDeltaVeeMultiDof2(start.data(), 1.0);
  }
  bodies_.clear();
  return btMultiBodyConstraintSolver::solveGroupCacheFriendlyFinish(bodies, body_count, info);
}

void CasterSolver::noteStart() {
  bodies_.clear();
  const auto note = [this](const btMultiBodyConstraintArray& rows) {
    for (int i = 0; i < rows.size(); ++i) {
      noteBody(rows[i].m_multiBodyA, rows[i].m_deltaVelAindex);
      noteBody(rows[i].m_multiBodyB, rows[i].m_deltaVelBindex);
    }
  };
  note(m_multiBodyNonContactConstraints);
  note(m_multiBodyNormalContactConstraints);
  const int count = m_data.m_deltaVelocities.size();
  start_velocities_.resize(static_cast<std::size_t>(count));
  if (count > 0) {
    std::copy_n(&m_data.m_deltaVelocities[0], count, start_velocities_.begin());
  }
}

void CasterSolver::noteBody(btMultiBody* body, int index) {
  if (body == nullptr) return;
  const auto entry = std::make_pair(body, index);
  if (std::find(bodies_.begin(), bodies_.end(), entry) == bodies_.end()) bodies_.push_back(entry);
}

double CasterSolver::solveJointRow(const Row& row) {
  const int dof = 6 + row.m_multiBodyA->getLink(row.m_linkA).m_dofOffset;
  const double velocity = m_data.m_deltaVelocities[row.m_deltaVelAindex + dof];
  const double before = row.m_appliedImpulse;
  const double after = std::clamp<double>(before + row.m_rhs - velocity * row.m_jacDiagABInv,
                                          row.m_lowerLimit, row.m_upperLimit);
  if (after == before) return 0.0;
  row.m_appliedImpulse = after;
  apply(row, after - before);
  return squaredVelocity(after - before, row);
}

double CasterSolver::solveNormalRow(const Row& row) {
  const double before = row.m_appliedImpulse;
  const double after = std::max(0.0, before + impulseFor(row));
  if (after == before) return 0.0;
  row.m_appliedImpulse = after;
  apply(row, after - before);
  return squaredVelocity(after - before, row);
}

double CasterSolver::solveFrictionRows(const Row& a, const Row& b, double limit) {
  const double before_a = a.m_appliedImpulse;
  const double before_b = b.m_appliedImpulse;
  if (limit <= 0.0 && before_a == 0.0 && before_b == 0.0) return 0.0;
  double after_a = before_a + impulseFor(a);
  double after_b = before_b + impulseFor(b);
  const double size = std::sqrt(after_a * after_a + after_b * after_b);
  if (size > limit) {
    after_a *= limit / size;
    after_b *= limit / size;
  }
  a.m_appliedImpulse = after_a;
  b.m_appliedImpulse = after_b;
  apply(a, after_a - before_a);
  apply(b, after_b - before_b);
  return squaredVelocity(after_a - before_a, a) + squaredVelocity(after_b - before_b, b);
}

double CasterSolver::impulseFor(const Row& row) {
  double velocity = 0.0;
  if (row.m_multiBodyA != nullptr) {
    const int n = row.m_multiBodyA->getNumDofs() + 6;
    velocity += Velocities(&m_data.m_jacobians[row.m_jacAindex], n)
                    .dot(Velocities(&m_data.m_deltaVelocities[row.m_deltaVelAindex], n));
  } else if (row.m_solverBodyIdA >= 0) {
    btSolverBody& body = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    velocity += row.m_contactNormal1.dot(body.internalGetDeltaLinearVelocity()) +
                row.m_relpos1CrossNormal.dot(body.internalGetDeltaAngularVelocity());
  }
  if (row.m_multiBodyB != nullptr) {
    const int n = row.m_multiBodyB->getNumDofs() + 6;
    velocity += Velocities(&m_data.m_jacobians[row.m_jacBindex], n)
                    .dot(Velocities(&m_data.m_deltaVelocities[row.m_deltaVelBindex], n));
  } else if (row.m_solverBodyIdB >= 0) {
    btSolverBody& body = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    velocity += row.m_contactNormal2.dot(body.internalGetDeltaLinearVelocity()) +
                row.m_relpos2CrossNormal.dot(body.internalGetDeltaAngularVelocity());
  }
  return row.m_rhs - row.m_appliedImpulse * row.m_cfm - velocity * row.m_jacDiagABInv;
}

void CasterSolver::apply(const Row& row, double impulse) {
  if (row.m_multiBodyA != nullptr) {
    const int n = row.m_multiBodyA->getNumDofs() + 6;
    Velocities(&m_data.m_deltaVelocities[row.m_deltaVelAindex], n) +=
        impulse * Velocities(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacAindex], n);
  } else if (row.m_solverBodyIdA >= 0) {
    btSolverBody& body = m_tmpSolverBodyPool[row.m_solverBodyIdA];
    body.internalApplyImpulse(row.m_contactNormal1 * body.internalGetInvMass(),
                              row.m_angularComponentA, impulse);
  }
  if (row.m_multiBodyB != nullptr) {
    const int n = row.m_multiBodyB->getNumDofs() + 6;
    Velocities(&m_data.m_deltaVelocities[row.m_deltaVelBindex], n) +=
        impulse * Velocities(&m_data.m_deltaVelocitiesUnitImpulse[row.m_jacBindex], n);
  } else if (row.m_solverBodyIdB >= 0) {
    btSolverBody& body = m_tmpSolverBodyPool[row.m_solverBodyIdB];
    body.internalApplyImpulse(row.m_contactNormal2 * body.internalGetInvMass(),
                              row.m_angularComponentB, impulse);
  }
}

}  // namespace casepush::sim
