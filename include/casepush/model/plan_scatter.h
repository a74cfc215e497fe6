#pragma once

#include "casepush/model/push_plan.h"

namespace casepush {

/// Where a chain of pushes ends if each scatters as its case says and nobody plans anew, starting
/// from `map_start`. First order, see compound(). Of an empty chain: `map_start`.
///
/// The rest of a plan from an observed pose has the scatter
/// `compoundedEnd(rest.pushes, {map_T_object, measurement covariance}).covariance`.
/// @param pushes  Chained: only how each one moves the object counts, not where the first starts.
PoseGaussian compoundedEnd(const std::vector<PlannedPush>& pushes, const PoseGaussian& map_start);

/// Probability that a pose drawn from `map_pose` lies in the goal region, by 256 fixed samples.
double goalProbability(const PoseGaussian& map_pose, const Pose2& map_T_goal,
                       const GoalTolerance& tolerance);

/// Sets `map_compounded` of every push and `goal_probability`: the start is known exactly.
void compoundPushes(PushPlan* plan);

}  // namespace casepush
