#include "rest_of_plan.h"

#include <algorithm>

#include "casepush/model/plan_scatter.h"

namespace casepush {

RestVerdict judgeRest(const PushPlanner::Continuation& rest, const RestOptions& options) {
  if (rest.may_get_stuck) {
    return {false, ReplanCause::kDeadEndAhead,
            "the next push may leave the object where no case can be applied"};
  }
  if (rest.valid) {
    return {true, {}, {}};
  }
  const PushPlan& plan = rest.plan;
  const int horizon = std::min(options.horizon, static_cast<int>(plan.pushes.size()));
  if (!rest.chained || rest.applicable < horizon) {
    return {false, ReplanCause::kRestCollides, rest.explanation};
  }
  const PoseGaussian end = compoundedEnd(plan.pushes, PoseGaussian{plan.object.map_T_object});
  if (plan.tolerance.isMet(plan.map_T_goal, end.mean)) {
    return {true, {}, {}};  // What collides is farther ahead than anybody can say.
  }
  if (options.rule == RestRule::kLikelyEnd) {
    const PoseGaussian aimed{plan.map_T_goal, end.covariance};
    const double at_best = goalProbability(aimed, plan.map_T_goal, plan.tolerance);
    if (goalProbability(end, plan.map_T_goal, plan.tolerance) >= options.least_share * at_best) {
      return {true, {}, {}};
    }
  }
  return {false, ReplanCause::kRestMissesGoal, rest.explanation};
}

}  // namespace casepush
