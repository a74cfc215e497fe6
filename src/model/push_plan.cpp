#include "casepush/model/push_plan.h"

#include <cmath>

#include "casepush/common/check.h"

namespace casepush {

bool GoalTolerance::isMet(const Pose2& goal, const Pose2& pose) const {
  return distance(goal, pose) <= position_m && std::abs(yawDifference(goal, pose)) <= yaw_rad;
}

double PushPlan::lengthM() const {
  double length_m = 0.0;
  Pose2 last = object.map_T_object;
  for (const PlannedPush& push : pushes) {
    length_m += distance(last, push.map_outcome.mean);
    last = push.map_outcome.mean;
  }
  return length_m;
}

const char* toString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kInvalidRequest:
      return "invalid request";
    case PlanStatus::kNoCases:
      return "no cases";
    case PlanStatus::kStartInCollision:
      return "start in collision";
    case PlanStatus::kGoalInCollision:
      return "goal in collision";
    case PlanStatus::kGoalOutsideMap:
      return "goal outside map";
    case PlanStatus::kUnreachable:
      return "unreachable";
    case PlanStatus::kDeadline:
      return "deadline";
    case PlanStatus::kCancelled:
      return "cancelled";
    case PlanStatus::kPlannerGone:
      return "planner gone";
  }
  CASEPUSH_CHECK(false, "PlanStatus " << static_cast<int>(status));
}

}  // namespace casepush
