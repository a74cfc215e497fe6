#pragma once

#include <actionlib/server/action_server.h>
#include <casepush/ExecutePushAction.h>
#include <casepush/ExecutorState.h>
#include <casepush/PushObjectAction.h>
#include <casepush/TaskSummary.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "casepush/execution/execute_push.h"
#include "casepush/execution/push_task.h"

namespace casepush {

/// How an activity of the executor came to its end.
enum class ActivityEnd {
  kFinished,   ///< Its behaviour succeeded or failed.
  kCancelled,  ///< By the action's client.
  kStopped,    ///< By the service stop, or because time stood still.
};

/// Where a push belongs, for its report.
struct ReportContext {
  int plan_number = 0;
  int push_index = 0;
  bool adapted = false;
  std::string replan_cause;  ///< Why the plan before this one was given up; with its first push.
};
using ReportSink = std::function<void(const PushReport&, const ReportContext&)>;

/// The context of a report of a task.
/// @param reported_replans  How many of the task's re-plans were told before; counted on.
ReportContext reportContext(const PushTaskProgress& progress, bool adapt, const PushReport& report,
                            std::size_t* reported_replans);

/// "no_progress": as the constants of the result in lower case.
std::string statusName(PushTaskStatus status);

/// What is to be recorded of a task, without header.
/// @param goal_id, start_stamp_s  Of the action's goal, and when the task began.
/// @param status, explanation  How it ended, if it ended by itself; an empty one: as the task says.
TaskSummary summaryOf(const std::string& goal_id, const PushTaskGoal& goal, const PushTask& task,
                      PushTaskStatus status, const std::string& explanation, double start_stamp_s);
using SummarySink = std::function<void(TaskSummary)>;

/// A behaviour that an action goal asked for.
class Activity {
 public:
  virtual ~Activity() = default;

  virtual Tick tick(const Observation& observation) = 0;
  virtual void cancel() = 0;  ///< The next tick ends it.

  virtual std::string goalId() const = 0;
  virtual std::string describe() const = 0;
  virtual ExecutorState state() const = 0;  ///< Without header.
  virtual void publishFeedback() = 0;

  /// What is to be recorded of it when it has ended, without header; nothing if it is no task.
  virtual std::optional<TaskSummary> summary() const { return std::nullopt; }

  /// Sends the action's result.
  virtual void finish(ActivityEnd end, const std::string& explanation, double now_s) = 0;
};

/// An activity that is one behaviour, asked for by the goal of one action.
template <typename GoalHandle, typename Work>
class GoalActivity : public Activity {
 public:
  Tick tick(const Observation& observation) override {
    if (!start_stamp_s_) start_stamp_s_ = observation.stamp_s;
    return work_.tick(observation);
  }
  void cancel() override { work_.cancel(); }
  std::string goalId() const override { return goal_.getGoalID().id; }
  std::string describe() const override { return work_.describe(); }

 protected:
  /// @param work  A member of the derived class, which may not have been made yet.
  GoalActivity(GoalHandle goal, Work& work) : goal_(std::move(goal)), work_(work) {}

  const std::optional<double>& startStamp() const { return start_stamp_s_; }
  /// Since the first tick [s].
  double duration(double now_s) const { return start_stamp_s_ ? now_s - *start_stamp_s_ : 0.0; }

  GoalHandle goal_;

 private:
  Work& work_;
  std::optional<double> start_stamp_s_;
};

using PushObjectServer = actionlib::ActionServer<PushObjectAction>;
using ExecutePushServer = actionlib::ActionServer<ExecutePushAction>;

/// The action push_object.
class PushObjectActivity : public GoalActivity<PushObjectServer::GoalHandle, PushTask> {
 public:
  /// @param sink  Called for each push.
  PushObjectActivity(PushObjectServer::GoalHandle goal, PushTaskGoal task_goal, RobotModel robot,
                     PushTaskServices services, PushTaskOptions options, ReportSink sink);

  ExecutorState state() const override;
  void publishFeedback() override;
  std::optional<TaskSummary> summary() const override;
  void finish(ActivityEnd end, const std::string& explanation, double now_s) override;

 private:
  PushTaskServices withReports(PushTaskServices services, ReportSink sink);
  PushObjectResult result(ActivityEnd end, const std::string& explanation, double now_s) const;

  PushTaskGoal task_goal_;
  PushTask task_;
  double last_t_squared_ = 0.0;
  std::size_t reported_replans_ = 0;
};

/// The action execute_push.
class ExecutePushActivity : public GoalActivity<ExecutePushServer::GoalHandle, ExecutePush> {
 public:
  ExecutePushActivity(ExecutePushServer::GoalHandle goal, ExecutePush push, ReportSink sink);

  ExecutorState state() const override;
  void publishFeedback() override;
  void finish(ActivityEnd end, const std::string& explanation, double now_s) override;

 private:
  ExecutePush push_;
  ReportSink sink_;
};

const char* toString(ExecutePush::Phase phase);

/// Of a task that pushes an object; activity, object and description are left to the caller.
ExecutorState stateOf(const PushTaskProgress& progress);

/// Ends a goal in the state that belongs to how its activity ended.
template <typename GoalHandle, typename Result>
void endGoal(GoalHandle& goal, ActivityEnd how, bool success, const Result& result) {
  if (how == ActivityEnd::kCancelled) {
    goal.setCanceled(result, result.explanation);
  } else if (success) {
    goal.setSucceeded(result, result.explanation);
  } else {
    goal.setAborted(result, result.explanation);
  }
}

}  // namespace casepush
