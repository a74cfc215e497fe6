// What becomes of the rest of a plan once a push has ended somewhere.
#include <algorithm>
#include <optional>
#include <vector>

#include "casepush/model/plan_scatter.h"
#include "dead_end_check.h"
#include "plan_request.h"
#include "planner_data.h"

namespace casepush {

// Chains the plan's pushes from its object's pose and tells which of them can be applied.
void PushPlanner::Data::chain(const std::vector<Case>& cases, PushChecker* push_checker,
                              Continuation* rest) const {
  const double step_m = kStepPerCell * push_checker->collisions().columns().resolution_m;
  PushPlan& plan = rest->plan;
  const double object_radius_m = objects.at(plan.object.model).radius_m;
  Pose2 pose = plan.object.map_T_object;
  for (std::size_t i = 0; i < plan.pushes.size(); ++i) {
    PlannedPush& push = plan.pushes[i];
    const std::string name =
        "push " + std::to_string(i + 1) + " (case " + std::to_string(push.case_id) + ")";
    const Case* found = findCase(cases, push.case_id);
    if (found == nullptr) {
      rest->explanation = name + ": the case no longer exists";
      return;
    }
    if (rest->explanation.empty()) {
      const auto prepared =
          prepareCases({*found}, plan.zeta, step_m, object_radius_m, robot.radius_m);
      const PushConflict conflict = push_checker->conflict(prepared.front(), pose);
      if (conflict == PushConflict::kNone) {
        ++rest->applicable;
      } else {
        rest->explanation = name + ": " + toString(conflict);
      }
    }
    push.map_T_start = pose;
    push.map_outcome = transform(pose, found->start_outcome);
    pose = push.map_outcome.mean;
  }
  rest->chained = true;
  if (plan.max_collision_probability) {
    assessPlan(cases, {step_m, object_radius_m, robot.radius_m}, options.risk, push_checker, &plan);
    rest->applicable = std::min(rest->applicable, bearablePushes(plan));
    if (rest->explanation.empty()) rest->explanation = riskExplanation(plan);
  }
  if (rest->explanation.empty() && !plan.tolerance.isMet(plan.map_T_goal, pose)) {
    rest->explanation = "the rest of the plan now ends at " + describe(pose) + ", " +
                        rounded(distance(pose, plan.map_T_goal), 2) + " m from the goal";
  }
}

// May the first push of a plan leave the object where no case can be applied?
bool PushPlanner::Data::mayGetStuck(const PushPlan& plan, const std::vector<Case>& cases,
                                    const std::vector<PlacedObject>& obstacles,
                                    const std::vector<PlacedSolid>& placed,
                                    PushChecker* push_checker) const {
  std::vector<const Case*> own;
  for (const Case& push_case : cases) {
    if (push_case.id >= 0 && isFor(push_case, plan.object.model, robot.name))
      own.push_back(&push_case);
  }
  const double step_m = kStepPerCell * push_checker->collisions().columns().resolution_m;
  std::vector<std::optional<PreparedCase>> prepared(own.size());
  const auto prepare = [&](int i) -> const PreparedCase& {
    if (!prepared[i]) {
      prepared[i] = prepareCase(*own[i], plan.zeta, step_m, objects.at(plan.object.model).radius_m,
                                robot.radius_m);
    }
    return *prepared[i];
  };
  const auto pushed =
      std::find(own.begin(), own.end(), findCase(cases, plan.pushes.front().case_id));
  if (pushed == own.end()) return false;
  PlanRequest request;
  request.object = plan.object;
  request.map_T_goal = plan.map_T_goal;
  request.tolerance = plan.tolerance;
  request.obstacles = obstacles;
  const SearchProblem problem = this->problem(request, own, placed);
  ApproachVerifier ways(problem, push_checker->collisions(), {});
  DeadEndCheck check(request, static_cast<int>(own.size()), prepare, push_checker, &ways);
  return check.mayEndInOne(plan.object.map_T_object,
                           prepare(static_cast<int>(pushed - own.begin())));
}

PushPlanner::Continuation PushPlanner::continuePlan(
    const PushPlan& rest, const Pose2& map_T_object, const std::vector<Case>& cases,
    const std::vector<PlacedObject>& obstacles) const {
  Continuation result;
  std::vector<PlacedObject> all = obstacles;
  all.push_back({rest.object.id, rest.object.model, map_T_object});
  result.explanation = checkObstacles(all, data_->objects);
  if (!result.explanation.empty()) {
    return result;
  }
  const std::vector<PlacedSolid> placed = placeObstacles(obstacles, data_->objects);
  PushChecker checker = data_->pushChecker(rest.object.model, placed);
  checker.tolerateStart(map_T_object);
  result.plan = rest;
  result.plan.object.map_T_object = map_T_object;
  data_->chain(cases, &checker, &result);
  result.valid = result.explanation.empty();
  result.may_get_stuck = result.applicable > 0 && keepsOutOfDeadEnds(data_->options) &&
                         data_->mayGetStuck(result.plan, cases, obstacles, placed, &checker);
  compoundPushes(&result.plan);
  return result;
}

}  // namespace casepush
