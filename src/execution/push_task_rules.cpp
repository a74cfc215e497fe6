#include "push_task_rules.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/common/violations.h"

namespace casepush {
namespace {

constexpr double kSigmas = 2.0;

}  // namespace

const char* toString(PushTaskStatus status) {
  switch (status) {
    case PushTaskStatus::kRunning:
      return "running";
    case PushTaskStatus::kSucceeded:
      return "succeeded";
    case PushTaskStatus::kCancelled:
      return "cancelled";
    case PushTaskStatus::kInvalidGoal:
      return "invalid goal";
    case PushTaskStatus::kNoPlan:
      return "no plan";
    case PushTaskStatus::kPlannerGone:
      return "planner gone";
    case PushTaskStatus::kObjectLost:
      return "object lost";
    case PushTaskStatus::kRobotLost:
      return "robot lost";
    case PushTaskStatus::kNoProgress:
      return "no progress";
    case PushTaskStatus::kTimeout:
      return "timeout";
  }
  return "unknown";
}

const char* toString(RestRule rule) {
  return rule == RestRule::kMeanAtGoal ? "mean_at_goal" : "likely_end";
}

void PushTaskOptions::validate() const {
  push.validate();
  clear.validate();
  search.validate();
  Violations violations;
  violations.require("max_replans", max_replans, 0, 100000);
  violations.require("max_pushes", max_pushes, 1, 100000);
  violations.require("max_failed_plans", max_failed_plans, 1, 1000);
  violations.require("max_idle_pushes", max_idle_pushes, 1, 1000);
  violations.require("max_plans_without_progress", max_plans_without_progress, 1, 100000);
  violations.require("plan_deadline_s", plan_deadline_s, 0.01, 3600.0);
  violations.require("look_timeout_s", look_timeout_s, 0.1, 3600.0);
  violations.require("max_searches", max_searches, 0, 1000);
  violations.require("rest.least_share", rest.least_share, 0.0, 1.0);
  violations.require("rest.horizon", rest.horizon, 1, 100000);
  violations.require("goal_share", goal_share, 0.1, 1.0);
  violations.require("goal_margin_m", goal_margin_m, 0.0, 1.0);
  violations.require("goal_margin_rad", goal_margin_rad, 0.0, 1.0);
  violations.throwIfAny("push task options");
}

PushTaskServices completeServices(PushTaskServices services, const std::string& object_id) {
  const PushPlanner* checker = services.checker;
  if (services.plans == nullptr || !services.cases) {
    throw InputError("push task", "a plan client and the cases are required");
  }
  if (checker == nullptr && (!services.continue_plan || !services.approach)) {
    throw InputError("push task", "a checker, or continue_plan and approach, are required");
  }
  if (!services.continue_plan) {
    services.continue_plan = [checker](const PushPlan& rest, const Pose2& map_T_object,
                                       const std::vector<Case>& cases,
                                       const std::vector<PlacedObject>& obstacles) {
      return checker->continuePlan(rest, map_T_object, cases, obstacles);
    };
  }
  if (!services.in_the_way) {
    services.in_the_way = [checker, cases = services.cases](
                              const PushPlan& plan, const std::vector<PlacedObject>& objects) {
      return checker == nullptr ? std::vector<std::string>{}
                                : checker->inTheWay(plan, *cases(), objects);
    };
  }
  if (!services.touches && checker != nullptr) {
    services.touches = touchCheck(
        [checker] { return std::shared_ptr<const PushPlanner>(std::shared_ptr<void>(), checker); },
        object_id);
  }
  if (!services.approach) {
    services.approach = approachPlanner(*checker, object_id);
  }
  return services;
}

bool isInvalidGoal(PlanStatus status) {
  return status == PlanStatus::kInvalidRequest || status == PlanStatus::kNoCases ||
         status == PlanStatus::kGoalInCollision || status == PlanStatus::kGoalOutsideMap;
}

bool isSensible(const PushTaskGoal& goal) {
  return goal.map_T_goal.isFinite() && goal.tolerance.position_m > 0.0 &&
         goal.tolerance.yaw_rad > 0.0 && goal.time_limit_s > 0.0;
}

bool isSafelyAtGoal(const PushTaskGoal& goal, const ObjectState& object,
                    const PushTaskOptions& options) {
  const Eigen::Matrix3d& covariance = object.covariance;
  const double sigma_m = std::sqrt(std::max(0.0, covariance.topLeftCorner<2, 2>().trace()));
  const double sigma_rad = std::sqrt(std::max(0.0, covariance(2, 2)));
  const double most = 1.0 - options.goal_share;
  GoalTolerance tolerance = goal.tolerance;
  tolerance.position_m -=
      std::min(most * tolerance.position_m, std::max(options.goal_margin_m, kSigmas * sigma_m));
  tolerance.yaw_rad -=
      std::min(most * tolerance.yaw_rad, std::max(options.goal_margin_rad, kSigmas * sigma_rad));
  return tolerance.isMet(goal.map_T_goal, object.map_T_object);
}

PlanRequest planRequest(const PushTaskGoal& goal, const PushTaskOptions& options,
                        const Observation& observation, const ObjectState& object,
                        int plan_number) {
  PlanRequest request;
  request.object = {object.id, object.model, object.map_T_object};
  request.map_T_goal = goal.map_T_goal;
  request.tolerance = goal.tolerance;
  request.tolerance.position_m *= options.goal_share;
  request.tolerance.yaw_rad *= options.goal_share;
  request.map_T_robot = observation.map_T_robot;
  // 31 bits, so that the seed passes through every message and file as a number.
  request.seed = Random::stream(goal.seed, "plan " + std::to_string(plan_number)).below(1u << 31);
  request.deadline_s = options.plan_deadline_s;
  return request;
}

std::string limitReached(const std::string& object_id, const PushTaskProgress& progress,
                         const PushTaskOptions& options, int plans_without_progress) {
  const std::vector<std::string>& reasons = progress.replan_reasons;
  const std::string still =
      ": still " + errorText(progress.distance_to_goal_m, progress.yaw_to_goal_rad) +
      (reasons.empty() ? "" : " (the last plan was given up: " + reasons.back() + ")");
  if (progress.pushes >= options.max_pushes) {
    return "not at the goal after " + std::to_string(progress.pushes) + " pushes" + still;
  }
  if (progress.replans > options.max_replans) {
    return "not at the goal after " + std::to_string(options.max_replans) + " new plans" + still;
  }
  if (progress.idle_pushes >= options.max_idle_pushes) {
    return object_id + " did not move in " + std::to_string(progress.idle_pushes) +
           " pushes in a row" + still;
  }
  if (plans_without_progress >= options.max_plans_without_progress) {
    return std::to_string(plans_without_progress) + " plans in a row brought " + object_id +
           " no nearer" + still;
  }
  return {};
}

std::string errorText(double position_m, double yaw_rad) {
  char text[64];
  std::snprintf(text, sizeof(text), "%.2f m and %.0f deg from the goal", position_m,
                yaw_rad * 180.0 / M_PI);
  return text;
}

}  // namespace casepush
