#pragma once

#include <string>

namespace casepush {

/// What a plan must be safe for.
enum class RiskModel {
  kSigmaPoints,  ///< Each push for itself: the sigma points of its outcome (paper eq. 4-6).
  kChance,       ///< The whole plan: a bound on the probability of a collision.
};

/// "sigma_points", "chance".
const char* toString(RiskModel model);
/// @throws InputError naming the models that there are.
RiskModel riskModel(const std::string& name);

struct RiskOptions {
  RiskModel model = RiskModel::kSigmaPoints;

  // With chance constraints:
  double max_collision_probability = 0.05;  ///< Of a whole plan, in (0, 1].
  /// Pushes whose scatter adds up before somebody looks where the object is and corrects the plan.
  int horizon = 2;
  /// What a push costs that does not work out, in expected time: plan anew, push once more [s].
  double recovery_s = 25.0;
};

}  // namespace casepush
