#include "guess.h"

#include <Eigen/Eigenvalues>

namespace casepush {

void makeGuess(Case* push_case, const Eigen::Matrix3d& scatter,
               const Eigen::Matrix3d& mean_uncertainty) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      mean_uncertainty, scatter, Eigen::EigenvaluesOnly | Eigen::Ax_lBx);
  push_case->effective_count = 1.0 / (1.0 + solver.eigenvalues().maxCoeff());
  push_case->start_outcome.covariance = scatter / push_case->effective_count;
}

}  // namespace casepush
