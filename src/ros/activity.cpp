#include "casepush/ros/activity.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "casepush/ros/conversions.h"
#include "casepush/ros/push_conversions.h"

namespace casepush {
namespace {

// The codes of the result are those of the core.
static_assert(PushObjectResult::SUCCEEDED == static_cast<int>(PushTaskStatus::kSucceeded));
static_assert(PushObjectResult::CANCELLED == static_cast<int>(PushTaskStatus::kCancelled));
static_assert(PushObjectResult::INVALID_GOAL == static_cast<int>(PushTaskStatus::kInvalidGoal));
static_assert(PushObjectResult::NO_PLAN == static_cast<int>(PushTaskStatus::kNoPlan));
static_assert(PushObjectResult::PLANNER_GONE == static_cast<int>(PushTaskStatus::kPlannerGone));
static_assert(PushObjectResult::OBJECT_LOST == static_cast<int>(PushTaskStatus::kObjectLost));
static_assert(PushObjectResult::ROBOT_LOST == static_cast<int>(PushTaskStatus::kRobotLost));
static_assert(PushObjectResult::NO_PROGRESS == static_cast<int>(PushTaskStatus::kNoProgress));
static_assert(PushObjectResult::TIMEOUT == static_cast<int>(PushTaskStatus::kTimeout));

std::uint32_t count(int value) { return static_cast<std::uint32_t>(value); }

}  // namespace

std::string statusName(PushTaskStatus status) {
  std::string name = toString(status);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

const char* toString(ExecutePush::Phase phase) {
  switch (phase) {
    case ExecutePush::Phase::kApproach:
      return "approach";
    case ExecutePush::Phase::kDock:
      return "dock";
    case ExecutePush::Phase::kPush:
      return "push";
    case ExecutePush::Phase::kRest:
      return "rest";
    case ExecutePush::Phase::kFinished:
      return "finished";
  }
  return "unknown";
}

ReportContext reportContext(const PushTaskProgress& progress, bool adapt, const PushReport& report,
                            std::size_t* reported_replans) {
  ReportContext context;
  context.plan_number = static_cast<int>(progress.pushes_per_plan.size());
  context.push_index = progress.push_index;
  context.adapted = adapt && report.case_id > 0 && isObservation(report);
  if (progress.replan_history.size() > *reported_replans) {
    context.replan_cause = toString(progress.replan_history.back());
    *reported_replans = progress.replan_history.size();
  }
  return context;
}

PushObjectActivity::PushObjectActivity(PushObjectServer::GoalHandle goal, PushTaskGoal task_goal,
                                       RobotModel robot, PushTaskServices services,
                                       PushTaskOptions options, ReportSink sink)
    : GoalActivity(std::move(goal), task_),
      task_goal_(std::move(task_goal)),
      task_(task_goal_, std::move(robot), withReports(std::move(services), std::move(sink)),
            options) {}

PushTaskServices PushObjectActivity::withReports(PushTaskServices services, ReportSink sink) {
  services.on_report = [this, sink = std::move(sink)](const PushReport& report) {
    last_t_squared_ = report.test.t_squared;
    sink(report, reportContext(task_.progress(), task_goal_.adapt, report, &reported_replans_));
  };
  return services;
}

ExecutorState stateOf(const PushTaskProgress& progress) {
  ExecutorState state;
  state.phase = progress.phase;
  state.push_index = count(progress.push_index);
  state.push_count = count(progress.push_count);
  state.pushes = count(progress.pushes);
  state.plans = count(progress.plans);
  state.replans = count(progress.replans);
  state.rejected_predictions = count(progress.rejected_predictions);
  state.distance_to_goal = progress.distance_to_goal_m;
  state.yaw_to_goal = progress.yaw_to_goal_rad;
  return state;
}

ExecutorState PushObjectActivity::state() const {
  ExecutorState state = stateOf(task_.progress());
  state.activity = ExecutorState::PUSHING_OBJECT;
  state.object_id = task_goal_.object_id;
  state.description = task_.describe();
  return state;
}

void PushObjectActivity::publishFeedback() {
  const ExecutorState now = state();
  PushObjectFeedback feedback;
  feedback.phase = now.phase;
  feedback.description = now.description;
  feedback.push_index = now.push_index;
  feedback.push_count = now.push_count;
  feedback.pushes = now.pushes;
  feedback.clearing_pushes = count(task_.progress().clearing_pushes);
  feedback.replans = now.replans;
  feedback.deviation = last_t_squared_;
  feedback.distance_to_goal = now.distance_to_goal;
  feedback.yaw_to_goal = now.yaw_to_goal;
  goal_.publishFeedback(feedback);
}

PushObjectResult PushObjectActivity::result(ActivityEnd how, const std::string& explanation,
                                            double now_s) const {
  const PushTaskProgress& progress = task_.progress();
  PushObjectResult result;
  result.status = static_cast<std::uint8_t>(task_.status());
  if (how == ActivityEnd::kStopped) result.status = PushObjectResult::STOPPED;
  if (how == ActivityEnd::kCancelled) result.status = PushObjectResult::CANCELLED;
  result.explanation = explanation.empty() ? task_.describe() : explanation;
  result.position_error = progress.distance_to_goal_m;
  result.yaw_error = std::abs(progress.yaw_to_goal_rad);
  result.pushes = count(progress.pushes);
  result.clearing_pushes = count(progress.clearing_pushes);
  result.plans = count(progress.plans);
  result.replans = count(progress.replans);
  result.repairs = count(progress.repairs);
  result.rejected_predictions = count(progress.rejected_predictions);
  result.plan_length = progress.plan_length_m;
  result.duration = duration(now_s);
  return result;
}

TaskSummary summaryOf(const std::string& goal_id, const PushTaskGoal& goal, const PushTask& task,
                      PushTaskStatus status, const std::string& explanation, double start_stamp_s) {
  const PushTaskProgress& progress = task.progress();
  TaskSummary summary;
  summary.goal_id = goal_id;
  summary.object_id = goal.object_id;
  summary.goal = toMessage(goal.map_T_goal);
  summary.position_tolerance = goal.tolerance.position_m;
  summary.yaw_tolerance = goal.tolerance.yaw_rad;
  summary.start_stamp = toRosTime(start_stamp_s);
  summary.status = statusName(status);
  summary.explanation = explanation.empty() ? task.describe() : explanation;
  summary.position_error = progress.distance_to_goal_m;
  summary.yaw_error = std::abs(progress.yaw_to_goal_rad);
  summary.plan_length = progress.plan_length_m;
  summary.plans = count(progress.plans);
  summary.repairs = count(progress.repairs);
  std::transform(progress.pushes_per_plan.begin(), progress.pushes_per_plan.end(),
                 std::back_inserter(summary.pushes_of_plans), count);
  summary.pushes = count(progress.pushes);
  summary.clearing_pushes = count(progress.clearing_pushes);
  summary.rejected_predictions = count(progress.rejected_predictions);
  std::transform(progress.replan_history.begin(), progress.replan_history.end(),
                 std::back_inserter(summary.replan_causes),
                 [](ReplanCause cause) { return toString(cause); });
  summary.replan_reasons = progress.replan_reasons;
  return summary;
}

std::optional<TaskSummary> PushObjectActivity::summary() const {
  return summaryOf(goalId(), task_goal_, task_, task_.status(), "", startStamp().value_or(0.0));
}

void PushObjectActivity::finish(ActivityEnd how, const std::string& explanation, double now_s) {
  endGoal(goal_, how, task_.status() == PushTaskStatus::kSucceeded,
          result(how, explanation, now_s));
}

ExecutePushActivity::ExecutePushActivity(ExecutePushServer::GoalHandle goal, ExecutePush push,
                                         ReportSink sink)
    : GoalActivity(std::move(goal), push_), push_(std::move(push)), sink_(std::move(sink)) {}

ExecutorState ExecutePushActivity::state() const {
  ExecutorState state;
  state.activity = ExecutorState::EXECUTING_PUSH;
  state.object_id = goal_.getGoal()->object_id;
  state.phase = toString(push_.phase());
  state.description = push_.describe();
  return state;
}

void ExecutePushActivity::publishFeedback() {
  ExecutePushFeedback feedback;
  feedback.phase = toString(push_.phase());
  feedback.description = push_.describe();
  goal_.publishFeedback(feedback);
}

void ExecutePushActivity::finish(ActivityEnd how, const std::string& explanation,
                                 double /*now_s*/) {
  ExecutePushResult result;
  result.explanation = explanation.empty() ? push_.describe() : explanation;
  result.status = how == ActivityEnd::kFinished    ? ExecutePushResult::EXECUTED
                  : how == ActivityEnd::kCancelled ? ExecutePushResult::CANCELLED
                                                   : ExecutePushResult::STOPPED;
  if (push_.report()) {
    sink_(*push_.report(), ReportContext{});
    result.report = toMessage(*push_.report());
  }
  endGoal(goal_, how, how == ActivityEnd::kFinished, result);
}

}  // namespace casepush
