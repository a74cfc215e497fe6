#pragma once

#include <string>

#include "casepush/execution/push_task.h"

namespace casepush {

/// Fills continue_plan, in_the_way and approach from the checker.
/// @throws InputError if a required service is missing.
PushTaskServices completeServices(PushTaskServices services, const std::string& object_id);

/// True if the goal pose is finite and tolerances and time limit are positive.
bool isSensible(const PushTaskGoal& goal);
constexpr const char* kNotSensible =
    "the goal pose must be finite, tolerances and time limit positive";

/// True if no other attempt can find a plan: there are no cases, or the goal is in a collision or
/// outside of the map.
bool isInvalidGoal(PlanStatus status);

/// True if the object is within the goal's tolerance by a margin: the pose is observed with some
/// error, and what counts is where the object really is. The margin is two standard deviations, but
/// leaves at least goal_share of the tolerance.
bool isSafelyAtGoal(const PushTaskGoal& goal, const ObjectState& object,
                    const PushTaskOptions& options);

/// What to ask the planner for: the inner part of the tolerance, with a seed of its own for each
/// plan. Without obstacles.
PlanRequest planRequest(const PushTaskGoal& goal, const PushTaskOptions& options,
                        const Observation& observation, const ObjectState& object, int plan_number);

/// Why a task that is not at the goal should be given up; empty: it should not.
/// @param plans_without_progress  Plans in a row, none shorter than the best before.
std::string limitReached(const std::string& object_id, const PushTaskProgress& progress,
                         const PushTaskOptions& options, int plans_without_progress);

/// "0.31 m and 12 deg from the goal".
std::string errorText(double position_m, double yaw_rad);

}  // namespace casepush
