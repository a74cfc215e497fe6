#pragma once

#include <actionlib/client/action_client.h>
#include <casepush/PlanPushAction.h>
#include <ros/ros.h>

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "casepush/model/push_plan.h"
#include "casepush/ros/search_choice.h"

namespace casepush {

/// Asks the planner node for plans over the action plan_push. Callbacks come with the global queue.
class ActionPlanClient : public PlanClient {
 public:
  explicit ActionPlanClient(ros::NodeHandle handle);

  /// How requests from now on are to be planned.
  void setSearch(SearchChoice search) { search_ = std::move(search); }

  void request(const PlanRequest& request) override;
  std::optional<PlanResult> poll() override;
  void cancel() override;

  /// False as soon as the planner's sockets close, or if it does not answer in time.
  bool isAlive() const override;

 private:
  using Client = actionlib::ActionClient<PlanPushAction>;
  using SteadyClock = std::chrono::steady_clock;

  void onTransition(const Client::GoalHandle& goal);

  ros::NodeHandle handle_;
  SearchChoice search_;
  mutable Client client_;
  Client::GoalHandle goal_;
  bool pending_ = false;
  std::optional<PlanResult> result_;
  SteadyClock::time_point answer_due_;
};

}  // namespace casepush
