#include "casepush/ros/map_follower.h"

#include <memory>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {

MapFollower::MapFollower(const Furnishing& furnishing, const PushPlannerOptions& options,
                         ros::NodeHandle handle)
    : planner_(furnishing, options), spinner_(1, &queue_) {
  handle.setCallbackQueue(&queue_);
  octomap_ = handle.subscribe(names::kOctomap.name, names::kOctomap.queue_size,
                              &MapFollower::onOctomap, this);
  spinner_.start();
}

MapFollower::~MapFollower() { spinner_.stop(); }

void MapFollower::onOctomap(const Octomap& message) {
  try {
    planner_.setMap(std::make_shared<const Map>(fromMessage(message)));
  } catch (const InputError& error) {
    ROS_ERROR("map ignored: %s", error.what());
  }
}

}  // namespace casepush
