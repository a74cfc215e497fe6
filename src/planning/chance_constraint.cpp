#include "chance_constraint.h"

#include <algorithm>
#include <cmath>

namespace casepush {

ChanceConstraint::ChanceConstraint(const PushRisk& risk, double max_collision_probability,
                                   const Pose2& map_T_goal, const GoalTolerance& tolerance)
    : risk_(risk),
      most_risk_(riskOf(max_collision_probability)),
      map_T_goal_(map_T_goal),
      tolerance_(tolerance) {
  for (int push = 0; push < risk.caseCount(); ++push) {
    drift_s_.push_back(risk.options().recovery_s * risk.expectedReplans(push, tolerance));
  }
}

std::optional<PushChance> ChanceConstraint::judge(int push, const Pose2& map_T_start,
                                                  const Pose2& map_T_end,
                                                  double risk_so_far) const {
  const Eigen::Matrix3d start = risk_.startCovariance(before_);
  const double left = most_risk_ - risk_so_far;
  const double collision =
      risk_.collisionProbability(push, map_T_start, start, probabilityOf(left));
  PushChance chance;
  chance.risk = riskOf(collision);
  // A mean motion that collides risks infinitely much: too much even where anything is allowed.
  if (!std::isfinite(chance.risk) || chance.risk > left) return std::nullopt;
  double failure = collision;
  if (risk_.options().recovery_s > 0.0) {
    const Eigen::Matrix3d drifted = risk_.driftedCovariance(before_);
    failure = std::max(failure, risk_.obstructionProbability(push, map_T_start, drifted));
  }
  if (tolerance_.isMet(map_T_goal_, map_T_end)) {
    failure += risk_.missProbability(push, map_T_start, start, map_T_goal_, tolerance_);
  }
  chance.recovery_s = risk_.options().recovery_s * failure;
  return chance;
}

}  // namespace casepush
