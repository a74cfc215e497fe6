// How PushTask mends the end of a plan: while a push is made, those after it are planned anew.
#include <utility>

#include "push_task_data.h"
#include "push_task_rules.h"

namespace casepush {

// The next push is as good as it was. Only its successors miss the goal, and there is time to find
// others until it is made.
bool PushTask::Data::beginRepair(const RestVerdict& verdict, const PushPlan& rest_of_plan,
                                 const Observation& observation) {
  if (!options.rest.repair || repair_failed || verdict.cause != ReplanCause::kRestMissesGoal ||
      rest_of_plan.pushes.size() < 2) {
    return false;
  }
  const PlannedPush& next = rest_of_plan.pushes.front();
  const auto cases = services.cases();
  const Case* const push_case = findCase(*cases, next.case_id);
  const ObjectState* const object = usableObject(observation, goal.object_id);
  if (push_case == nullptr || object == nullptr) return false;
  ObjectState expected = *object;
  expected.map_T_object = next.map_outcome.mean;
  PlanRequest tail = planRequest(goal, options, observation, expected, progress.plans);
  tail.map_T_robot = next.map_outcome.mean * push_case->steps.back().object_T_robot;
  // Around the others: whether to clear them away is decided when a whole plan is made.
  tail.obstacles = otherObjects(observation, goal.object_id);
  services.plans->request(tail);
  is_repairing = true;
  return true;
}

void PushTask::Data::endRepair() {
  if (!std::exchange(is_repairing, false)) return;
  const std::optional<PlanResult> tail = services.plans->poll();
  repair_failed = !tail || tail->status != PlanStatus::kSolved || tail->plan.pushes.empty();
  if (!tail) {
    services.plans->cancel();
    return;
  }
  ++progress.plans;
  if (services.on_plan) services.on_plan(*tail);
  if (repair_failed) return;
  ++progress.repairs;
  progress.pushes_unchanged.push_back(0);
  notePlan(*tail);
}

void PushTask::Data::dropRepair() {
  if (is_repairing) services.plans->cancel();
  is_repairing = false;
  repair_failed = false;
}

}  // namespace casepush
