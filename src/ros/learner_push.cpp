// How LearnerNode has its pushes executed.
#include "casepush/ros/push_conversions.h"
#include "learner_run.h"

namespace casepush {
namespace {

constexpr int kRefusals = 5;  // In a row by the executor, before learning gives up.
constexpr std::chrono::milliseconds kBetweenRefusals(500);  // Wall time.

/// Whether the executor may take a goal later that it did not take now. What was begun and stopped
/// must not be begun again.
bool isRefusal(std::uint8_t status) {
  return status == ExecutePushResult::BUSY || status == ExecutePushResult::NOT_READY ||
         status == ExecutePushResult::INVALID_GOAL;
}

}  // namespace

std::optional<PushReport> LearnerNode::execute(Run& run, const Exploration::Trial& trial) {
  ExecutePushGoal goal;
  goal.object_id = run.object_id;
  goal.case_id = trial.case_id.value_or(0);
  goal.configuration = toMessage(trial.configuration);
  for (int refusals = 0; refusals < kRefusals; ++refusals) {
    if (refusals > 0) {
      waitUntil([] { return false; }, kBetweenRefusals);
    }
    publishProgress(run, trial);
    const std::string problem = reset(run, trial);
    if (endIfAsked(run)) {
      return std::nullopt;
    }
    if (!problem.empty()) {
      run.fail(LearnObjectResult::FAILED, problem);
      ROS_WARN("reset: %s", problem.c_str());
      continue;
    }
    const std::optional<ExecutePushResult> result = call(goal, run);
    if (!result) {
      return std::nullopt;
    }
    if (result->status == ExecutePushResult::EXECUTED) {
      return fromMessage(result->report);
    }
    run.fail(result->status == ExecutePushResult::CANCELLED ? LearnObjectResult::CANCELLED
                                                            : LearnObjectResult::FAILED,
             "execute_push: " + result->explanation + Run::kKept);
    // The executor may not have heard of a case that was stored a moment ago.
    if (!isRefusal(result->status)) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<ExecutePushResult> LearnerNode::call(const ExecutePushGoal& goal, Run& run) {
  {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    push_done_ = false;
  }
  execute_push_.sendGoal(goal, [this](const actionlib::SimpleClientGoalState& /*state*/,
                                      const ExecutePushResultConstPtr& /*result*/) {
    const std::lock_guard<std::mutex> lock(state_mutex_);
    push_done_ = true;
    state_changed_.notify_all();
  });
  while (!waitForChange([this] { return push_done_; })) {
    if (endIfAsked(run)) {
      execute_push_.cancelGoal();
      return std::nullopt;
    }
    if (!execute_push_.isServerConnected()) {
      run.fail(LearnObjectResult::EXECUTOR_GONE, "action execute_push went away");
      return std::nullopt;
    }
  }
  const ExecutePushResultConstPtr result = execute_push_.getResult();
  if (result == nullptr) {
    run.fail(LearnObjectResult::EXECUTOR_GONE, "action execute_push has lost the push");
    return std::nullopt;
  }
  return *result;
}

}  // namespace casepush
