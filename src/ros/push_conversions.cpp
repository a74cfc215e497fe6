#include "casepush/ros/push_conversions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "casepush/planning/risk_options.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

// The codes of messages are those of the core.
static_assert(PushCase::EXPLORED == static_cast<int>(CaseOrigin::kExplored));
static_assert(PushCase::TRANSFERRED == static_cast<int>(CaseOrigin::kTransferred));
static_assert(ExecutedPush::DONE == static_cast<int>(PushOutcome::kDone));
static_assert(ExecutedPush::CANCELLED == static_cast<int>(PushOutcome::kCancelled));
static_assert(ExecutedPush::APPROACH_FAILED == static_cast<int>(PushOutcome::kApproachFailed));
static_assert(ExecutedPush::OBJECT_LOST == static_cast<int>(PushOutcome::kObjectLost));
static_assert(ExecutedPush::ROBOT_LOST == static_cast<int>(PushOutcome::kRobotLost));
static_assert(ExecutedPush::NOT_MOVED == static_cast<int>(PushOutcome::kNotMoved));
static_assert(ExecutedPush::TIMEOUT == static_cast<int>(PushOutcome::kTimeout));
static_assert(ExecutedPush::BROKEN_OFF == static_cast<int>(PushOutcome::kBrokenOff));
static_assert(ExecutedPush::BLOCKED == static_cast<int>(PushOutcome::kBlocked));
static_assert(ExecutedPush::STOPPED_SHORT == static_cast<int>(PushOutcome::kStoppedShort));
static_assert(PlanPushResult::SOLVED == static_cast<int>(PlanStatus::kSolved));
static_assert(PlanPushResult::INVALID_REQUEST == static_cast<int>(PlanStatus::kInvalidRequest));
static_assert(PlanPushResult::NO_CASES == static_cast<int>(PlanStatus::kNoCases));
static_assert(PlanPushResult::START_IN_COLLISION ==
              static_cast<int>(PlanStatus::kStartInCollision));
static_assert(PlanPushResult::GOAL_IN_COLLISION == static_cast<int>(PlanStatus::kGoalInCollision));
static_assert(PlanPushResult::GOAL_OUTSIDE_MAP == static_cast<int>(PlanStatus::kGoalOutsideMap));
static_assert(PlanPushResult::UNREACHABLE == static_cast<int>(PlanStatus::kUnreachable));
static_assert(PlanPushResult::DEADLINE == static_cast<int>(PlanStatus::kDeadline));
static_assert(PlanPushResult::CANCELLED == static_cast<int>(PlanStatus::kCancelled));
static_assert(PlanPushResult::PLANNER_GONE == static_cast<int>(PlanStatus::kPlannerGone));

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

template <typename Enum>
Enum enumFrom(int code, Enum last, const char* where) {
  if (code < 0 || code > static_cast<int>(last)) {
    throw InputError(where, "unknown code " + std::to_string(code));
  }
  return static_cast<Enum>(code);
}

double finite(double value, const char* where) {
  if (!std::isfinite(value)) {
    throw InputError(where, "a number is not finite");
  }
  return value;
}

double probability(double value, const char* where) {
  if (!(value >= 0.0 && value <= 1.0)) {
    throw InputError(where, "is " + std::to_string(value) + ", a probability is in [0, 1]");
  }
  return value;
}

/// Somewhat above pi, which a person rounds.
constexpr double kAnyYaw_rad = 3.15;

PushSample toMessage(const CaseStep& step) {
  PushSample message;
  message.object_T_robot = toMessage(step.object_T_robot);
  message.start_T_object = toMessage(step.start_T_object);
  message.vx = step.action.vx_mps;
  message.vy = step.action.vy_mps;
  message.wz = step.action.wz_rps;
  return message;
}

}  // namespace

GoalTolerance goalTolerance(double position_m, double yaw_rad) {
  Violations violations;
  violations.require("position_tolerance [m]", position_m, 0.0, 1000.0);
  violations.require("yaw_tolerance [rad]", yaw_rad, 0.0, kAnyYaw_rad);
  violations.throwIfAny("goal");
  GoalTolerance result;
  if (position_m > 0.0) {
    result.position_m = position_m;
  }
  if (yaw_rad > 0.0) {
    result.yaw_rad = std::min(yaw_rad, M_PI);
  }
  return result;
}

PushCase toMessage(const Case& push_case) {
  PushCase message;
  message.id = push_case.id;
  message.object = push_case.object;
  message.robot = push_case.robot;
  message.origin = static_cast<std::uint8_t>(push_case.origin);
  message.period = push_case.period_s;
  message.push_steps = static_cast<std::uint32_t>(push_case.push_steps);
  for (const CaseStep& step : push_case.steps) {
    message.steps.push_back(toMessage(step));
  }
  message.outcome = toMessage(push_case.start_outcome);
  message.effective_count = push_case.effective_count;
  message.observation_count = static_cast<std::uint32_t>(push_case.observation_count);
  message.source_id = push_case.source_id;
  message.load = push_case.context.load_kg.value_or(kUnknown);
  message.floor = push_case.context.floor;
  message.noticed = static_cast<std::uint32_t>(push_case.context.noticed);
  for (const PoseGaussian& step : push_case.tube) {
    message.tube.push_back(toMessage(step));
  }
  return message;
}

Case fromMessage(const PushCase& message) {
  Case push_case;
  push_case.id = message.id;
  push_case.object = message.object;
  push_case.robot = message.robot;
  push_case.origin = enumFrom(message.origin, CaseOrigin::kTransferred, "case message: origin");
  push_case.period_s = message.period;
  push_case.push_steps = static_cast<int>(message.push_steps);
  for (const PushSample& sample : message.steps) {
    push_case.steps.push_back({fromMessage(sample.object_T_robot),
                               Twist2{sample.vx, sample.vy, sample.wz},
                               fromMessage(sample.start_T_object)});
  }
  push_case.start_outcome = fromMessage(message.outcome);
  push_case.effective_count = message.effective_count;
  push_case.observation_count = static_cast<int>(message.observation_count);
  push_case.source_id = message.source_id;
  if (!std::isnan(message.load)) {
    push_case.context.load_kg = message.load;
  }
  push_case.context.floor = message.floor;
  push_case.context.noticed = static_cast<int>(message.noticed);
  for (const Pose2DWithCovariance& step : message.tube) {
    push_case.tube.push_back(fromMessage(step));
  }
  return push_case;
}

PushCaseArray toMessage(const std::vector<Case>& cases, double stamp_s) {
  PushCaseArray message;
  message.header.stamp = toRosTime(stamp_s);
  for (const Case& push_case : cases) {
    message.cases.push_back(toMessage(push_case));
  }
  return message;
}

std::vector<Case> fromMessage(const PushCaseArray& message) {
  std::vector<Case> cases;
  for (const PushCase& push_case : message.cases) {
    cases.push_back(fromMessage(push_case));
    validateCase(cases.back(), "case " + std::to_string(push_case.id) + " of a message");
  }
  return cases;
}

TrialPush toMessage(const PushConfiguration& configuration) {
  TrialPush message;
  message.object_T_robot = toMessage(configuration.object_T_robot);
  message.direction = configuration.direction_rad;
  message.speed = configuration.speed_mps;
  message.yaw_rate = configuration.yaw_rate_rps;
  message.duration = configuration.duration_s;
  return message;
}

PushConfiguration fromMessage(const TrialPush& message) {
  PushConfiguration configuration;
  configuration.object_T_robot = fromMessage(message.object_T_robot);
  configuration.direction_rad = finite(message.direction, "configuration: direction");
  configuration.speed_mps = finite(message.speed, "configuration: speed");
  configuration.yaw_rate_rps = finite(message.yaw_rate, "configuration: yaw_rate");
  configuration.duration_s = finite(message.duration, "configuration: duration");
  return configuration;
}

Plan toMessage(const PushPlan& plan, double stamp_s) {
  Plan message;
  message.header.stamp = toRosTime(stamp_s);
  message.header.frame_id = names::kMapFrame;
  message.object = toMessage(plan.object);
  message.goal = toMessage(plan.map_T_goal);
  message.position_tolerance = plan.tolerance.position_m;
  message.yaw_tolerance = plan.tolerance.yaw_rad;
  for (const PlannedPush& push : plan.pushes) {
    PlanStep step;
    step.case_id = push.case_id;
    step.start = toMessage(push.map_T_start);
    step.outcome = toMessage(push.map_outcome);
    step.compounded = toMessage(push.map_compounded);
    step.collision_probability = push.collision_probability;
    message.pushes.push_back(step);
  }
  message.risk =
      toString(plan.max_collision_probability ? RiskModel::kChance : RiskModel::kSigmaPoints);
  message.zeta = plan.zeta;
  message.max_collision_probability = plan.max_collision_probability.value_or(0.0);
  message.collision_probability = plan.collision_probability;
  message.goal_probability = plan.goal_probability;
  message.length = plan.lengthM();
  return message;
}

PushPlan fromMessage(const Plan& message) {
  PushPlan plan;
  plan.object = fromMessage(message.object);
  plan.map_T_goal = fromMessage(message.goal);
  plan.tolerance = goalTolerance(message.position_tolerance, message.yaw_tolerance);
  plan.zeta = finite(message.zeta, "plan: zeta");
  for (const PlanStep& step : message.pushes) {
    plan.pushes.push_back({step.case_id, fromMessage(step.start), fromMessage(step.outcome),
                           fromMessage(step.compounded),
                           probability(step.collision_probability, "plan: a push")});
  }
  if (!message.risk.empty() && riskModel(message.risk) == RiskModel::kChance) {
    plan.max_collision_probability =
        probability(message.max_collision_probability, "plan: max_collision_probability");
  }
  plan.collision_probability =
      probability(message.collision_probability, "plan: collision_probability");
  plan.goal_probability = probability(message.goal_probability, "plan: goal_probability");
  return plan;
}

ExecutedPush toMessage(const PushReport& report) {
  ExecutedPush message;
  message.object_id = report.object_id;
  message.case_id = report.case_id;
  message.outcome = static_cast<std::uint8_t>(report.outcome);
  message.explanation = report.explanation;
  message.start_stamp = toRosTime(report.start_stamp_s);
  message.end_stamp = toRosTime(report.end_stamp_s);
  message.start = toMessage(report.map_T_start);
  message.expected = toMessage(report.map_expected);
  message.observed = toMessage(report.map_T_end);
  message.t_squared = report.test.t_squared;
  message.p_value = report.test.p_value;
  message.rejected = report.test.rejected;
  message.recorded = toMessage(report.recorded);
  return message;
}

PushReport fromMessage(const ExecutedPush& message) {
  PushReport report;
  report.object_id = message.object_id;
  report.case_id = message.case_id;
  report.outcome = enumFrom(message.outcome, kLastPushOutcome, "push report: outcome");
  report.explanation = message.explanation;
  report.start_stamp_s = message.start_stamp.toSec();
  report.end_stamp_s = message.end_stamp.toSec();
  report.map_T_start = fromMessage(message.start);
  report.map_expected = fromMessage(message.expected);
  report.map_T_end = fromMessage(message.observed);
  report.test.t_squared = finite(message.t_squared, "push report: t_squared");
  report.test.p_value = finite(message.p_value, "push report: p_value");
  report.test.rejected = message.rejected;
  report.recorded = fromMessage(message.recorded);
  return report;
}

PlanPushGoal toMessage(const PlanRequest& request) {
  PlanPushGoal message;
  message.object_id = request.object.id;
  message.goal.header.frame_id = names::kMapFrame;
  message.goal.pose = toPoseMessage(request.map_T_goal);
  message.position_tolerance = request.tolerance.position_m;
  message.yaw_tolerance = request.tolerance.yaw_rad;
  message.seed = request.seed;
  message.deadline = request.deadline_s;
  message.state_given = true;
  message.objects.push_back(toMessage(request.object));
  for (const PlacedObject& obstacle : request.obstacles) {
    message.objects.push_back(toMessage(obstacle));
  }
  message.robot = toMessage(request.map_T_robot);
  return message;
}

PlanRequest fromMessage(const PlanPushGoal& message) {
  PlanRequest request;
  bool found = false;
  std::set<std::string> ids;
  for (const ObjectPose& object : message.objects) {
    if (!ids.insert(object.id).second) {
      throw InputError("goal: objects", "'" + object.id + "' is listed twice");
    }
    if (object.id == message.object_id) {
      request.object = fromMessage(object);
      found = true;
    } else {
      request.obstacles.push_back(fromMessage(object));
    }
  }
  if (!found) {
    throw InputError("goal: object_id",
                     "no object '" + message.object_id + "' is known (has it been seen?)");
  }
  request.map_T_goal = planarPose(fromMessage(message.goal.pose));
  request.tolerance = goalTolerance(message.position_tolerance, message.yaw_tolerance);
  request.map_T_robot = fromMessage(message.robot);
  request.seed = message.seed;
  if (message.deadline != 0.0) {
    request.deadline_s = finite(message.deadline, "goal: deadline");
  }
  return request;
}

PlanPushResult toMessage(const PlanResult& result, double stamp_s) {
  PlanPushResult message;
  message.status = static_cast<std::uint8_t>(result.status);
  message.explanation = result.explanation;
  message.plan = toMessage(result.plan, stamp_s);
  message.expected_time = result.expected_s;
  message.dead_end = static_cast<std::uint32_t>(result.dead_end);
  message.bound = result.bound;
  message.nodes = static_cast<std::uint32_t>(result.nodes);
  message.collision_checks = static_cast<std::uint32_t>(result.collision_checks);
  message.planning_time = result.planning_s;
  return message;
}

PlanResult fromMessage(const PlanPushResult& message) {
  PlanResult result;
  result.status = enumFrom(message.status, PlanStatus::kPlannerGone, "plan result: status");
  result.explanation = message.explanation;
  result.plan = fromMessage(message.plan);
  result.expected_s = message.expected_time;
  result.dead_end = static_cast<int>(message.dead_end);
  result.bound = message.bound;
  result.nodes = static_cast<int>(message.nodes);
  result.collision_checks = static_cast<int>(message.collision_checks);
  result.planning_s = message.planning_time;
  return result;
}

}  // namespace casepush
