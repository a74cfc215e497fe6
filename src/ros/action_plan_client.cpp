#include "casepush/ros/action_plan_client.h"

#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/names.h"
#include "casepush/ros/push_conversions.h"

namespace casepush {
namespace {

// Of wall time beyond the planner's own deadline, for a busy machine.
constexpr double kAnswerSlackS = 5.0;

PlanResult failed(PlanStatus status, const std::string& explanation) {
  PlanResult result;
  result.status = status;
  result.explanation = explanation;
  return result;
}

}  // namespace

ActionPlanClient::ActionPlanClient(ros::NodeHandle handle)
    : handle_(handle), client_(handle_, names::kPlanPushAction) {}

void ActionPlanClient::request(const PlanRequest& request) {
  cancel();
  pending_ = true;
  answer_due_ =
      SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(
                               std::chrono::duration<double>(request.deadline_s + kAnswerSlackS));
  PlanPushGoal goal = toMessage(request);
  goal.planner = search_.planner;
  goal.risk = search_.risk;
  goal.max_collision_probability = search_.max_collision_probability;
  goal.anytime = search_.anytime;
  goal_ =
      client_.sendGoal(goal, [this](const Client::GoalHandle& handle) { onTransition(handle); });
}

void ActionPlanClient::onTransition(const Client::GoalHandle& goal) {
  if (!pending_ || goal != goal_ || goal.getCommState() != actionlib::CommState::DONE) {
    return;
  }
  pending_ = false;
  const PlanPushResultConstPtr message = goal.getResult();
  if (message == nullptr) {
    result_ = failed(PlanStatus::kPlannerGone, "the planner dropped the request");
    return;
  }
  try {
    result_ = fromMessage(*message);
  } catch (const InputError& error) {
    result_ = failed(PlanStatus::kInvalidRequest, error.what());
  }
}

std::optional<PlanResult> ActionPlanClient::poll() {
  if (pending_ && !isAlive()) {
    pending_ = false;
    return failed(PlanStatus::kPlannerGone, "the planner node is gone (action plan_push)");
  }
  return std::exchange(result_, std::nullopt);
}

void ActionPlanClient::cancel() {
  if (pending_) {
    goal_.cancel();
  }
  pending_ = false;
  result_.reset();
}

bool ActionPlanClient::isAlive() const {
  return client_.isServerConnected() && !(pending_ && SteadyClock::now() > answer_due_);
}

}  // namespace casepush
