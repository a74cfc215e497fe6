#pragma once

#include <actionlib/client/simple_action_client.h>
#include <casepush/LearnObjectAction.h>
#include <casepush/PushObjectAction.h>
#include <casepush/PushableObjectArray.h>
#include <ros/ros.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "casepush/ros/collision_counter.h"
#include "casepush/ros/node_parameters.h"

namespace casepush {

/// The demonstration: learn the object, put everything back, push the object to the goal, judge by
/// ground truth, and write `summary.json`. Says on the console what goes on.
class DemoNode {
 public:
  DemoNode(DemoNodeParameters parameters, ros::NodeHandle handle);

  /// Returns the exit code: 0 if the object stands at the goal, 1 if not.
  int run();

 private:
  using LearnClient = actionlib::SimpleActionClient<LearnObjectAction>;
  using PushClient = actionlib::SimpleActionClient<PushObjectAction>;
  using SteadyClock = std::chrono::steady_clock;

  bool learn();
  bool putBack();
  bool push();
  void judge();
  void settle();
  void writeSummary() const;

  void showLearning(const LearnObjectFeedback& feedback);
  void showPushing(const PushObjectFeedback& feedback);
  bool wait(const std::function<bool()>& condition, double patience_s, const std::string& what);
  double wallSeconds() const;

  DemoNodeParameters parameters_;
  ros::NodeHandle handle_;

  std::mutex mutex_;  ///< Guards the following, which callbacks write.
  std::condition_variable changed_;
  std::optional<ObjectState> truth_;
  std::optional<ObjectState> seen_;
  CollisionCounter collisions_;
  bool counting_ = false;
  bool done_ = false;
  std::string last_line_;
  double last_line_wall_s_ = -1e9;

  ros::Subscriber truth_subscriber_;
  ros::Subscriber objects_subscriber_;
  ros::Subscriber contacts_subscriber_;
  LearnClient learn_;
  PushClient push_;
  ros::AsyncSpinner spinner_;

  SteadyClock::time_point start_;
  LearnObjectResult learn_result_;
  PushObjectResult push_result_;
  double learn_wall_s_ = 0.0;
  double push_wall_s_ = 0.0;
  bool success_ = false;
  std::string explanation_;
  double position_error_m_ = -1.0;  ///< By ground truth; negative if it never came.
  double yaw_error_rad_ = -1.0;
};

}  // namespace casepush
