#pragma once

#include <casepush/PlanPushAction.h>
#include <casepush/PushObjectAction.h>
#include <casepush/RearrangeAction.h>

#include <string>

#include "casepush/planning/push_planner.h"

namespace casepush {

/// What a goal says about how to plan; what it leaves open is as the node's parameters say.
struct SearchChoice {
  std::string planner;                     ///< By name; empty: open.
  std::string risk;                        ///< "sigma_points" or "chance"; empty: open.
  double max_collision_probability = 0.0;  ///< In (0, 1]; 0: open.
  bool anytime = false;
};

/// Of a goal of plan_push, push_object or rearrange.
SearchChoice searchOf(const PlanPushGoal& goal);
SearchChoice searchOf(const PushObjectGoal& goal);
SearchChoice searchOf(const RearrangeGoal& goal);

/// The node's options as changed by a goal.
/// @throws InputError naming the field and what it may be.
PushPlannerOptions withSearch(const PushPlannerOptions& options, const SearchChoice& choice);

}  // namespace casepush
