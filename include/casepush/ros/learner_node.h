#pragma once

#include <actionlib/client/simple_action_client.h>
#include <casepush/ExecutePushAction.h>
#include <casepush/ExecutedPush.h>
#include <casepush/ExportCases.h>
#include <casepush/ImportCases.h>
#include <casepush/LearnObjectAction.h>
#include <casepush/Octomap.h>
#include <ros/ros.h>
#include <std_msgs/Empty.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/case_base.h"
#include "casepush/execution/exploration.h"
#include "casepush/ros/demonstration_server.h"
#include "casepush/ros/diagnostics.h"
#include "casepush/ros/goal_server.h"
#include "casepush/ros/node_parameters.h"
#include "casepush/ros/object_watch.h"
#include "casepush/world/map.h"

namespace casepush {

/// Owner of the case base: learns objects by exploration (action learn_object) and demonstration
/// (services demonstration/...), adapts cases by the pushes of tasks, and tells everybody the
/// current cases.
///
/// Learning runs in the action's own thread and drives the robot through the action execute_push.
/// Each finished push is in the file before the next one begins.
class LearnerNode {
 public:
  /// @throws InputError if the case base cannot be opened; the file is left as it was.
  LearnerNode(LearnerNodeParameters parameters, ros::NodeHandle handle);

 private:
  using Server = GoalServer<LearnObjectAction>;
  using Client = actionlib::SimpleActionClient<ExecutePushAction>;

  /// One run of learn_object.
  struct Run;

  void onGoal(const LearnObjectGoalConstPtr& goal);
  void learn(const LearnObjectGoal& goal, Run& run);
  void resume(Run& run);  ///< With what is known in the present circumstances.
  ExplorationOptions explorationOptions(const LearnObjectGoal& goal) const;
  bool begin(Run& run);
  bool findGround(Run& run);
  std::shared_ptr<const Map> waitForMap();
  /// Chooses a push, executes it, and stores it. False if the run has to end: either exploration
  /// has finished, or the result says why.
  bool push(Run& run);
  std::optional<Exploration::Trial> nextTrial(Run& run);
  bool canTeleport();
  /// Waits for an object to be seen. Nothing if it is not, or the run should end.
  std::optional<ObjectState> see(const std::string& id);
  /// Waits for a moment or until the condition on guarded state holds; returns whether it does.
  bool waitForChange(const std::function<bool()>& condition);
  /// Looks at something that is not guarded, until it holds. False if it takes too long, or the run
  /// should end.
  bool waitUntil(const std::function<bool()>& condition, std::chrono::milliseconds patience);
  bool shouldEnd();           ///< The goal was cancelled, the robot was stopped, or ROS shuts down.
  bool endIfAsked(Run& run);  ///< If it should end, the result says why, and that it was asked to.

  /// Puts object and robot where the trial starts. Returns why not, or "".
  std::string reset(const Run& run, const Exploration::Trial& trial);
  /// Executes a trial. Nothing if the run has to end; its result says why.
  std::optional<PushReport> execute(Run& run, const Exploration::Trial& trial);
  /// Nothing as in execute().
  std::optional<ExecutePushResult> call(const ExecutePushGoal& goal, Run& run);
  void store(Run& run, const Exploration::Trial& trial, const PushReport& report);
  void publishProgress(const Run& run, const Exploration::Trial& trial);

  void onOctomap(const Octomap& message);
  void onReport(const ExecutedPush& message);
  void onStop(const std_msgs::Empty& message);
  std::string adaptBy(const PushReport& report);
  /// For the diagnostics: why the last push was not stored; empty if it was.
  void noteStored(const std::string& failure);
  bool onExport(ExportCases::Request& request, ExportCases::Response& response);
  bool onImport(ImportCases::Request& request, ImportCases::Response& response);
  std::int64_t addDemonstrated(const Case& push_case);
  void publishCases();
  void publishMarkers();
  void publishMarkersIfMoved();
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  LearnerNodeParameters parameters_;
  ros::NodeHandle handle_;
  std::mutex base_mutex_;
  CaseBase base_;  ///< Guarded by base_mutex_, with what adapts it.
  AdaptingCases adapting_;
  std::string store_failure_;  ///< Guarded likewise.
  ObjectWatch objects_;

  std::mutex state_mutex_;  ///< Guards the following.
  std::condition_variable state_changed_;
  std::string shown_object_;  ///< Instance around which cases are drawn.
  Pose2 shown_at_;
  bool push_done_ = false;
  bool was_stopped_ = false;        ///< By the service stop, since the run began.
  std::shared_ptr<const Map> map_;  ///< Null until there is one.

  ros::ServiceClient set_pose_;
  ros::Publisher cases_;
  ros::Publisher markers_;
  ros::Subscriber reports_subscriber_;
  ros::Subscriber octomap_subscriber_;
  ros::Subscriber stops_subscriber_;
  ros::ServiceServer export_;
  ros::ServiceServer import_;
  ros::WallTimer marker_timer_;
  Client execute_push_;
  Server server_;
  DemonstrationServer demonstrations_;
  Diagnostics diagnostics_;  ///< Last: its timer uses the members above.
};

}  // namespace casepush
