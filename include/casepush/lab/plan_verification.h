#pragma once

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

}  // namespace casepush
