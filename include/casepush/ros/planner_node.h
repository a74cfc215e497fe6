#pragma once

#include <casepush/PlanPushAction.h>
#include <casepush/PushCaseArray.h>
#include <casepush/PushableObjectArray.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <mutex>
#include <vector>

#include "casepush/ros/current_planner.h"
#include "casepush/ros/diagnostics.h"
#include "casepush/ros/goal_server.h"
#include "casepush/ros/map_source.h"
#include "casepush/ros/node_parameters.h"
#include "casepush/ros/transforms.h"

namespace casepush {

/// Makes plans from the map and the current cases: action plan_push.
///
/// Planning runs in the action's own thread, so that cancelling takes effect at once.
class PlannerNode {
 public:
  /// @throws InputError if the map file cannot be read.
  PlannerNode(PlannerNodeParameters parameters, ros::NodeHandle handle);

 private:
  using Server = GoalServer<PlanPushAction>;

  void onCases(const PushCaseArray& message);
  void onObjects(const PushableObjectArray& message);
  void onGoal(const PlanPushGoalConstPtr& goal);

  /// Completes a goal: goal pose in the map frame, current state unless it is given.
  PlanRequest request(const PlanPushGoal& goal);
  /// As a goal asks for, on the newest map; nullptr without a map.
  /// @throws InputError naming what cannot be asked for.
  std::shared_ptr<const PushPlanner> plannerFor(const PlanPushGoal& goal);
  PlanResult plan(const PlanPushGoal& goal);
  void show(const PlanResult& result, const std::vector<Case>& cases);
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  PlannerNodeParameters parameters_;
  ros::NodeHandle handle_;
  tf2_ros::Buffer buffer_;
  AheadWatch ahead_;
  tf2_ros::TransformListener listener_;

  CurrentPlanner planner_;
  std::mutex mutex_;  ///< Guards what the callbacks write and the action's thread reads.
  std::shared_ptr<const std::vector<Case>> cases_ = std::make_shared<const std::vector<Case>>();
  PushableObjectArray objects_;
  PlanResult last_result_;
  std::uint32_t plan_count_ = 0;

  ros::Publisher plan_;
  ros::Publisher plan_markers_;
  ros::Publisher tree_markers_;
  ros::Subscriber cases_subscriber_;
  ros::Subscriber objects_subscriber_;
  std::unique_ptr<MapSource> maps_;
  Server server_;
  Diagnostics diagnostics_;  ///< Last: its timer uses the members above.
};

}  // namespace casepush
