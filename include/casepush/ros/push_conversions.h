#pragma once

#include <casepush/ExecutedPush.h>
#include <casepush/Plan.h>
#include <casepush/PlanPushAction.h>
#include <casepush/PushCaseArray.h>
#include <casepush/TrialPush.h>

#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/model/case.h"
#include "casepush/model/push_plan.h"
#include "casepush/model/push_report.h"

/// Cases, plans and reports between ROS messages and the core. `fromMessage` throws InputError on
/// numbers that are not finite and codes that are unknown.
namespace casepush {

PushCase toMessage(const Case& push_case);
Case fromMessage(const PushCase& message);
PushCaseArray toMessage(const std::vector<Case>& cases, double stamp_s);
std::vector<Case> fromMessage(const PushCaseArray& message);

/// 0 stands for the default.
/// @throws InputError unless in [0, 1000] m and, but for rounding, [0, pi] rad.
GoalTolerance goalTolerance(double position_m, double yaw_rad);

TrialPush toMessage(const PushConfiguration& configuration);
PushConfiguration fromMessage(const TrialPush& message);

Plan toMessage(const PushPlan& plan, double stamp_s);
PushPlan fromMessage(const Plan& message);

/// Header, sequence and plan numbers are left to the caller.
ExecutedPush toMessage(const PushReport& report);
PushReport fromMessage(const ExecutedPush& message);

/// A request that carries its own state (state_given).
PlanPushGoal toMessage(const PlanRequest& request);
/// @pre message.state_given and a goal in the map frame.
/// @throws InputError also if `objects` lacks the object to push.
PlanRequest fromMessage(const PlanPushGoal& message);
PlanPushResult toMessage(const PlanResult& result, double stamp_s);
PlanResult fromMessage(const PlanPushResult& message);

}  // namespace casepush
