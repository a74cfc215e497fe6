#include "casepush/ros/rearrange_activity.h"

#include <cmath>
#include <utility>

namespace casepush {
namespace {

// The codes of the result are those of the core.
static_assert(RearrangeResult::SUCCEEDED == static_cast<int>(PushTaskStatus::kSucceeded));
static_assert(RearrangeResult::CANCELLED == static_cast<int>(PushTaskStatus::kCancelled));
static_assert(RearrangeResult::INVALID_GOAL == static_cast<int>(PushTaskStatus::kInvalidGoal));
static_assert(RearrangeResult::PLANNER_GONE == static_cast<int>(PushTaskStatus::kPlannerGone));
static_assert(RearrangeResult::ROBOT_LOST == static_cast<int>(PushTaskStatus::kRobotLost));
static_assert(RearrangeResult::NO_PROGRESS == static_cast<int>(PushTaskStatus::kNoProgress));
static_assert(RearrangeResult::TIMEOUT == static_cast<int>(PushTaskStatus::kTimeout));

}  // namespace

RearrangeActivity::RearrangeActivity(RearrangeServer::GoalHandle goal, RearrangeRequest request,
                                     RearrangeServices services, TaskMaker make_task,
                                     ReportSink sink, SummarySink summaries)
    : GoalActivity(std::move(goal), rearrange_),
      request_(std::move(request)),
      rearrange_(request_,
                 complete(std::move(services), std::move(make_task), std::move(sink),
                          std::move(summaries)),
                 RearrangeOptions{}) {}

RearrangeServices RearrangeActivity::complete(RearrangeServices services, TaskMaker make_task,
                                              ReportSink sink, SummarySink summaries) {
  services.make_task = [this, make_task = std::move(make_task),
                        sink = std::move(sink)](const PushTaskGoal& task) {
    return make_task(task, [this, sink, adapt = task.adapt,
                            told = std::size_t{0}](const PushReport& report) mutable {
      sink(report, reportContext(rearrange_.task()->progress(), adapt, report, &told));
    });
  };
  services.on_task_end = [this, summaries = std::move(summaries)](
                             const PushTaskGoal& goal, const PushTask& task, PushTaskStatus how,
                             const std::string& why, double began_s) {
    summaries(summaryOf(goalId(), goal, task, how, why, began_s));
  };
  return services;
}

std::optional<TaskSummary> RearrangeActivity::summary() const {
  const PushTask* task = rearrange_.task();
  if (task == nullptr) return std::nullopt;
  const PushTaskGoal& goal = request_.tasks[rearrange_.order()[rearrange_.turn()]];
  return summaryOf(goalId(), goal, *task, task->status(), "", rearrange_.taskBeganS());
}

Tick RearrangeActivity::tick(const Observation& observation) {
  last_ = observation;
  return GoalActivity::tick(observation);
}

ExecutorState RearrangeActivity::state() const {
  ExecutorState state;
  if (rearrange_.task() != nullptr) {
    state = stateOf(rearrange_.task()->progress());
    state.object_id = rearrange_.items()[rearrange_.order()[rearrange_.turn()]].object_id;
  } else {
    state.phase = rearrange_.isLooking() ? "look" : "order";
  }
  state.activity = ExecutorState::REARRANGING;
  state.description = rearrange_.describe();
  return state;
}

void RearrangeActivity::publishFeedback() {
  const ExecutorState now = state();
  RearrangeFeedback feedback;
  feedback.object_id = now.object_id;
  feedback.phase = now.phase;
  feedback.description = now.description;
  feedback.count = static_cast<std::uint32_t>(rearrange_.order().size());
  if (rearrange_.task() != nullptr) {
    feedback.number = static_cast<std::uint32_t>(rearrange_.turn() + 1);
    feedback.distance_to_goal = now.distance_to_goal;
    feedback.yaw_to_goal = now.yaw_to_goal;
  }
  goal_.publishFeedback(feedback);
}

RearrangedObject RearrangeActivity::resultOf(std::size_t index) const {
  const Rearrange::Item& item = rearrange_.items()[index];
  const PushTaskGoal& wanted = request_.tasks[index];
  RearrangedObject result;
  result.object_id = item.object_id;
  result.status = static_cast<std::uint8_t>(item.status);
  result.explanation = item.explanation;
  result.turns = static_cast<std::uint32_t>(item.attempts);
  result.pushes = static_cast<std::uint32_t>(item.pushes);
  result.position_error = -1.0;
  if (const ObjectState* object = last_.object(item.object_id)) {
    result.at_goal = wanted.tolerance.isMet(wanted.map_T_goal, object->map_T_object);
    result.position_error = distance(object->map_T_object, wanted.map_T_goal);
    result.yaw_error = std::abs(yawDifference(wanted.map_T_goal, object->map_T_object));
  }
  if (result.explanation.empty()) {
    result.explanation = result.at_goal ? "is at its goal" : "its turn has not come";
  }
  return result;
}

void RearrangeActivity::finish(ActivityEnd how, const std::string& explanation, double now_s) {
  RearrangeResult result;
  result.status = static_cast<std::uint8_t>(rearrange_.status());
  if (how == ActivityEnd::kStopped) result.status = RearrangeResult::STOPPED;
  if (how == ActivityEnd::kCancelled) result.status = RearrangeResult::CANCELLED;
  result.explanation = explanation.empty() ? rearrange_.describe() : explanation;
  for (std::size_t i = 0; i < rearrange_.items().size(); ++i) {
    result.objects.push_back(resultOf(i));
  }
  for (const int index : rearrange_.order()) {
    result.order.push_back(rearrange_.items()[index].object_id);
  }
  result.duration = duration(now_s);
  endGoal(goal_, how, rearrange_.status() == PushTaskStatus::kSucceeded, result);
}

}  // namespace casepush
