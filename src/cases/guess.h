#pragma once

#include "casepush/model/case.h"

namespace casepush {

/// Makes a case's covariance that of a guess: S / n with the scatter S of single pushes and the
/// effective count n < 1, such that it covers S + `mean_uncertainty` in every direction.
void makeGuess(Case* push_case, const Eigen::Matrix3d& scatter,
               const Eigen::Matrix3d& mean_uncertainty);

}  // namespace casepush
