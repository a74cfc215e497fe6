#pragma once

#include <casepush/ExecutedPush.h>
#include <casepush/PushCaseArray.h>
#include <casepush/PushableObjectArray.h>
#include <casepush/TaskSummary.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/common/silence_timer.h"
#include "casepush/ros/action_plan_client.h"
#include "casepush/ros/activity.h"
#include "casepush/ros/command_guard.h"
#include "casepush/ros/diagnostics.h"
#include "casepush/ros/map_follower.h"
#include "casepush/ros/node_parameters.h"
#include "casepush/ros/rearrange_activity.h"
#include "casepush/ros/stand_tally.h"
#include "casepush/ros/transforms.h"
#include "casepush/ros/watchdog.h"

namespace casepush {

/// The only writer of cmd_vel: ticks one behaviour at a time on each odometry message.
///
/// While no goal is active it passes on what a person asks for (teleop_cmd_vel), within the robot's
/// limits; while somebody drives, goals are refused.
/// The base is told to stand still whatever the behaviour says when the robot's or the objects'
/// poses are stale, and by a watchdog on wall time when ticks cease altogether.
class ExecutorNode {
 public:
  ExecutorNode(ExecutorNodeParameters parameters, ros::NodeHandle handle);

 private:
  using SteadyClock = std::chrono::steady_clock;

  void onCases(const PushCaseArray& message);
  void onObjects(const PushableObjectArray& message);
  void onOdometry(const nav_msgs::Odometry& message);
  void onPushObject(PushObjectServer::GoalHandle goal);
  void onExecutePush(ExecutePushServer::GoalHandle goal);
  void onRearrange(RearrangeServer::GoalHandle goal);
  template <typename GoalHandle>
  void onCancel(GoalHandle goal);
  bool onStop(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onTeleop(const geometry_msgs::Twist& message);
  void checkTeleop();
  /// Watches whether somebody else commands the base.
  void onCommand(const ros::MessageEvent<const geometry_msgs::Twist>& event);
  void checkTicks();

  /// Who is using the base; "" if nobody is.
  std::string whoIsBusy() const;
  /// Why nothing can be executed now; "" if all is there.
  std::string whatIsMissing() const;
  /// The same for tasks that push these objects.
  std::string whatIsMissingFor(const std::vector<std::string>& object_ids) const;
  PushTaskGoal taskGoal(const PushObjectGoal& goal) const;
  RearrangeRequest rearrangeRequest(const RearrangeGoal& goal) const;
  /// With whatever map and cases there are when they are asked.
  PushTaskServices::InTheWay inTheWay() const;
  PushTaskServices taskServices(const std::string& object_id);
  RearrangeServices rearrangeServices();  ///< But for make_task.
  ExecutePush makePush(const ExecutePushGoal& goal) const;
  ApproachPlanner approach(const std::string& object_id) const;
  bool hasCasesOf(const std::string& model) const;

  void begin(std::unique_ptr<Activity> activity);
  void tick(double now_s);
  std::optional<Observation> observe(double now_s);
  Twist2 safeCommand(const Observation& observation, const Twist2& wanted);
  void end(ActivityEnd how, const std::string& explanation);
  void finish();
  ReportSink reportSink();  ///< Both publish what they are called with.
  SummarySink summarySink();
  void publishReport(const PushReport& report, const ReportContext& context);
  void publishState(double now_s);
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  ExecutorNodeParameters parameters_;
  ros::NodeHandle handle_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;

  MapFollower map_;
  std::shared_ptr<const std::vector<Case>> cases_ = std::make_shared<const std::vector<Case>>();
  std::vector<ObjectState> objects_;
  double objects_stamp_s_ = -1e9;
  SilenceTimer objects_silence_;
  SilenceTimer observation_silence_;
  std::string blind_reason_;  ///< Why there was no observation.
  AheadWatch ahead_;
  nav_msgs::Odometry odometry_;

  CommandGuard guard_;
  ActionPlanClient plans_;
  std::unique_ptr<Activity> activity_;
  ActivityEnd end_ = ActivityEnd::kFinished;
  std::string end_explanation_;
  SteadyClock::time_point last_tick_;
  SteadyClock::time_point last_teleop_;
  bool teleop_ = false;  ///< Somebody drives.
  double last_stamp_s_ = 0.0;
  double last_state_s_ = -1e9;
  std::string last_phase_;
  std::string last_end_;  ///< How the last activity ended.
  std::uint32_t report_count_ = 0;
  int overridden_commands_ = 0;
  StandTally stands_;
  std::string foreign_commander_;    ///< Who else commanded the base last,
  double foreign_command_s_ = -1e9;  ///< and when, by the steady clock.

  ros::Publisher command_;
  ros::Publisher reports_;
  ros::Publisher summaries_;
  ros::Publisher state_;
  ros::Publisher stops_;
  ros::Subscriber cases_subscriber_;
  ros::Subscriber objects_subscriber_;
  ros::Subscriber odometry_subscriber_;
  ros::Subscriber teleop_subscriber_;
  ros::Subscriber command_subscriber_;
  ros::ServiceServer stop_;
  ros::WallTimer tick_check_;
  PushObjectServer push_object_;
  ExecutePushServer execute_push_;
  RearrangeServer rearrange_;
  Diagnostics diagnostics_;  ///< Its timer uses the members above.
  Watchdog watchdog_;        ///< Last: its thread uses command_.
};

}  // namespace casepush
