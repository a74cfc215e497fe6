#include "casepush/ros/current_planner.h"

#include <utility>

namespace casepush {

void CurrentPlanner::setMap(std::shared_ptr<const Map> map) {
  const std::shared_ptr<const PushPlanner> before = get();
  std::shared_ptr<const PushPlanner> planner =
      before != nullptr ? before->updated(std::move(map))
                        : std::make_unique<PushPlanner>(std::move(map), furnishing_.robot,
                                                        furnishing_.models, options_);
  const std::lock_guard<std::mutex> lock(mutex_);
  planner_ = std::move(planner);
}

std::shared_ptr<const PushPlanner> CurrentPlanner::get() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return planner_;
}

}  // namespace casepush
