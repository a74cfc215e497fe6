#pragma once

#include <vector>

#include "casepush/model/case.h"

namespace casepush {

/// How much is believed of a change of load or floor before anything was seen of it. Standard
/// deviations; "per" is per metre or radian of what the push does to the object.
struct ContextShiftOptions {
  double position_per_m = 0.2;    ///< [m/m]
  double position_per_rad = 0.1;  ///< [m/rad]
  double yaw_per_m = 0.6;         ///< [rad/m]
  double yaw_per_rad = 0.2;       ///< [rad/rad]
  double unexplained_m = 0.015;   ///< Of a single case, that no rule for all cases explains.
  double unexplained_rad = 0.05;
};

/// What other circumstances do to pushes, learnt from the cases observed in both.
///
/// A load moves the centre of mass and adds inertia, another floor adds drag: what that does to a
/// push goes with how far and whereto the push moves the object. So the change of the mean outcome
/// (x, y, yaw in the start frame) is taken as linear in the mean outcome itself, by Bayesian linear
/// regression (Bishop 2006, section 3.3) for each of its three components.
class ContextShift {
 public:
  explicit ContextShift(const ContextShiftOptions& options = {});

  /// One case observed in both circumstances: as it was, and its copy in the new ones.
  void add(const Case& before, const Case& now);

  /// What is to be expected of a case that was not observed in the new circumstances: its mean
  /// moves, and its covariance is S / n with n < 1 as in proposeCases(), so that the first push
  /// says more than the conjecture.
  Case conjecture(Case push_case) const;

 private:
  ContextShiftOptions options_;
  /// For each component of the change: precision of the weights, and precision times weights.
  Eigen::Matrix3d precision_[3];
  Eigen::Vector3d information_[3];
};

}  // namespace casepush
