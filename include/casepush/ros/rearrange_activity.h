#pragma once

#include <actionlib/server/action_server.h>
#include <casepush/RearrangeAction.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "casepush/execution/rearrange.h"
#include "casepush/ros/activity.h"

namespace casepush {

using RearrangeServer = actionlib::ActionServer<RearrangeAction>;

/// The action rearrange.
class RearrangeActivity : public GoalActivity<RearrangeServer::GoalHandle, Rearrange> {
 public:
  using OnReport = std::function<void(const PushReport&)>;
  /// Makes a task that calls `on_report` for each push.
  using TaskMaker = std::function<std::unique_ptr<PushTask>(const PushTaskGoal&, OnReport)>;

  /// @param services  But for make_task.
  /// @param sink      Called for each push, `summaries` for each task that has ended.
  /// @throws InputError as Rearrange.
  RearrangeActivity(RearrangeServer::GoalHandle goal, RearrangeRequest request,
                    RearrangeServices services, TaskMaker make_task, ReportSink sink,
                    SummarySink summaries);

  Tick tick(const Observation& observation) override;
  ExecutorState state() const override;
  void publishFeedback() override;
  /// Of the task that was under way when all was stopped.
  std::optional<TaskSummary> summary() const override;
  void finish(ActivityEnd end, const std::string& explanation, double now_s) override;

 private:
  RearrangeServices complete(RearrangeServices services, TaskMaker make_task, ReportSink sink,
                             SummarySink summaries);
  RearrangedObject resultOf(std::size_t index) const;

  RearrangeRequest request_;
  Rearrange rearrange_;
  Observation last_;
};

}  // namespace casepush
