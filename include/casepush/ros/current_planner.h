#pragma once

#include <memory>
#include <mutex>

#include "casepush/planning/push_planner.h"
#include "casepush/ros/node_parameters.h"

namespace casepush {

/// A planner on the newest map. Thread-safe: no one waits for a new map to be taken in.
class CurrentPlanner {
 public:
  CurrentPlanner(const Furnishing& furnishing, const PushPlannerOptions& options)
      : furnishing_(furnishing), options_(options) {}

  /// Of two calls at once the one that ends last counts. @throws InputError as the constructor of
  /// PushPlanner; then the planner before stays.
  void setMap(std::shared_ptr<const Map> map);

  /// Null until there is a map.
  std::shared_ptr<const PushPlanner> get() const;

 private:
  const Furnishing furnishing_;
  const PushPlannerOptions options_;
  mutable std::mutex mutex_;
  std::shared_ptr<const PushPlanner> planner_;
};

}  // namespace casepush
