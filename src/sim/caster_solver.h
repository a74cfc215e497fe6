#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include <utility>
#include <vector>

namespace casepush::sim {

/// Bullet's projected Gauss-Seidel for Featherstone bodies with a leaner inner loop.
///
/// The same rows in the same order, with vectorised products, joint rows by their single
/// coordinate, and the friction cone by scaling instead of by trigonometry. Handles what this room
/// builds: joint friction, contacts, two friction directions, no rolling or spinning friction rows.
class CasterSolver final : public btMultiBodyConstraintSolver {
 protected:
  btScalar solveSingleIteration(int iteration, btCollisionObject** bodies, int body_count,
                                btPersistentManifold** manifolds, int manifold_count,
                                btTypedConstraint** constraints, int constraint_count,
                                const btContactSolverInfo& info, btIDebugDraw* drawer) override;

  btScalar solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int body_count,
                                         const btContactSolverInfo& info) override;

 private:
  using Row = btMultiBodySolverConstraint;

  void noteStart();
  void noteBody(btMultiBody* body, int index);
  double solveJointRow(const Row& row);
  double solveNormalRow(const Row& row);
  double solveFrictionRows(const Row& a, const Row& b, double limit);
  double impulseFor(const Row& row);  ///< That would bring the row to its target velocity.
  void apply(const Row& row, double impulse);

  // Bullet hands every impulse to the bodies at once; here they get the sum at the end. Setting up
  // (warm starting) has already handed over what was there before the first iteration.
  std::vector<double> start_velocities_;
  std::vector<std::pair<btMultiBody*, int>> bodies_;  // With the index of their velocities.
};

}  // namespace casepush::sim
