#include "casepush/ros/search_choice.h"

#include <sstream>

#include "casepush/common/input_error.h"

namespace casepush {

SearchChoice searchOf(const PlanPushGoal& goal) {
  return {goal.planner, goal.risk, goal.max_collision_probability, goal.anytime != 0};
}

SearchChoice searchOf(const PushObjectGoal& goal) {
  return {goal.planner, goal.risk, goal.max_collision_probability};
}

SearchChoice searchOf(const RearrangeGoal& goal) {
  return {goal.planner, goal.risk, goal.max_collision_probability};
}

PushPlannerOptions withSearch(const PushPlannerOptions& options, const SearchChoice& choice) {
  PushPlannerOptions result = options;
  if (!choice.planner.empty() && plannerKind(choice.planner) != options.planner) {
    const auto preset = PushPlannerOptions::forPlanner(plannerKind(choice.planner));
    result.planner = preset.planner;
    result.similarity = preset.similarity;
    result.goal_bias = preset.goal_bias;
  }
  if (!choice.risk.empty()) result.risk.model = riskModel(choice.risk);
  if (choice.max_collision_probability != 0.0) {
    if (!(choice.max_collision_probability > 0.0 && choice.max_collision_probability <= 1.0)) {
      std::ostringstream what;
      what << "is " << choice.max_collision_probability
           << ", must be in (0, 1], or 0 for the planner's own";
      throw InputError("goal: max_collision_probability", what.str());
    }
    if (result.risk.model != RiskModel::kChance) {
      throw InputError("goal: max_collision_probability", "needs risk: chance");
    }
    result.risk.max_collision_probability = choice.max_collision_probability;
  }
  if (choice.anytime) result.improveUntilDeadline();
  result.validate();
  return result;
}

}  // namespace casepush
