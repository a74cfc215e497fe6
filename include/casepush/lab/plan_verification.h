#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/object_model.h"
#include "casepush/model/push_plan.h"
#include "casepush/model/robot_model.h"
#include "casepush/world/collision_checker.h"

namespace casepush {

struct PlanVerification {
  bool valid = true;
  int poses = 0;            ///< Tested with FCL.
  std::string explanation;  ///< The first thing that is wrong; empty if nothing is.
};

/// Tests a plan with nothing of what made it: FCL on the OctoMap, the true shapes without margins,
/// the recorded trajectories every centimetre, the sigma points of the plan's zeta, the chain of
/// outcomes and the goal. Overlaps of less than 1 mm are contacts. While the object leaves a start
/// at which it overlaps something already, it may overlap.
/// @throws InputError if casepush was built without FCL, or a case of the plan is missing.
PlanVerification verifyPlan(const Map& map, const std::vector<PlacedSolid>& obstacles,
                            const ObjectModel& object, const RobotModel& robot,
                            const PushPlan& plan, const std::vector<Case>& cases);

struct RiskVerification {
  bool valid = true;  ///< What the plan claims is not refuted.
  int draws = 0;
  double collision_probability = 0.0;  ///< Share of the draws in which something collides.
  double low = 0.0;                    ///< Its 95 % interval (Wilson's).
  double high = 0.0;
  double goal_probability = 0.0;  ///< Share of the draws that end in the goal region.
};

/// Draws executions of a plan and tests them with FCL: the outcome of every push is random, its
/// start has the deviations of the `horizon` - 1 pushes before it, object and robot move as
/// recorded from there (every 4 cm), the object with a deviation that grows to that of the outcome.
/// The goal is judged with the deviations of all pushes, as PushPlan::goal_probability. Refuted is
/// a plan whose allowed collision probability lies below the interval.
/// @throws InputError as verifyPlan.
RiskVerification verifyRisk(const Map& map, const std::vector<PlacedSolid>& obstacles,
                            const ObjectModel& object, const RobotModel& robot,
                            const PushPlan& plan, const std::vector<Case>& cases, int horizon,
                            int draws, std::uint64_t seed);

}  // namespace casepush
