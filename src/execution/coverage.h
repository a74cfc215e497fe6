#pragma once

#include <optional>
#include <vector>

#include "casepush/common/pose_gaussian.h"
#include "casepush/model/case.h"

namespace casepush {

/// Standard deviations of an outcome: position along its longest axis, and yaw; unbiased.
struct OutcomeSigma {
  double position_m;
  double yaw_rad;
};
OutcomeSigma outcomeSigma(const PoseGaussian& outcome, double effective_count);

/// d^2 = dx^2 + dy^2 + (rho dyaw)^2, rho the object's radius of gyration [m].
double outcomeDistance(const Pose2& a, const Pose2& b, double gyration_radius_m);

enum class Turn { kLeft, kNone, kRight };
Turn turnOf(const Pose2& start_T_object);

/// A stretch of directions without any known outcome.
struct DirectionGap {
  double from_rad;
  double width_rad;
};

/// Gaps between the directions of displacement, widest first; the full circle if there is none.
std::vector<DirectionGap> directionGaps(const std::vector<Pose2>& outcomes);

/// True if the robot slid off: after the push the object does not lie ahead of its motion any more.
bool hasLostContact(const Case& push_case);

}  // namespace casepush
