#pragma once

#include <casepush/Octomap.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <memory>

#include "casepush/ros/current_planner.h"

namespace casepush {

/// Keeps a planner on the map of the topic map/octomap, in a thread of its own: a large map takes
/// longer to read than a robot may be left without a command. Thread safety: all members.
class MapFollower {
 public:
  MapFollower(const Furnishing& furnishing, const PushPlannerOptions& options,
              ros::NodeHandle handle);
  ~MapFollower();

  /// Null until there is a map.
  std::shared_ptr<const PushPlanner> planner() const { return planner_.get(); }

 private:
  void onOctomap(const Octomap& message);

  CurrentPlanner planner_;
  ros::CallbackQueue queue_;
  ros::Subscriber octomap_;
  ros::AsyncSpinner spinner_;  ///< Last: stops before the others go.
};

}  // namespace casepush
