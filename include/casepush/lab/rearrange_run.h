#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "casepush/execution/rearrange.h"
#include "casepush/lab/push_run.h"

namespace casepush {

struct RearrangeRunResult {
  struct Object {
    Rearrange::Item item;
    bool at_goal = false;  ///< By ground truth, like the errors.
    double position_error_m = 0.0;
    double yaw_error_rad = 0.0;
  };

  bool success = false;  ///< All objects are at their goals, by ground truth.
  PushTaskStatus status = PushTaskStatus::kRunning;
  std::string explanation;
  std::vector<Object> objects;     ///< In the order of the request.
  std::vector<std::string> order;  ///< Ids, in the order of the last round.
  double sim_time_s = 0.0;
  double planning_s = 0.0;  ///< Wall time.
  int collisions = 0;
  std::vector<std::string> collision_names;
  std::vector<PushReport> reports;
};

/// Brings several objects of a world to their goals in the simulator.
/// @param request  Its time limit counts, not that of the options.
/// @param cases    Of all objects that may be pushed.
/// @param watch    Called after each tick.
/// @throws InputError naming an object that the world does not have, and as runPushTask().
RearrangeRunResult runRearrange(const Catalog& catalog, const WorldModel& world,
                                const RearrangeRequest& request, const std::vector<Case>& cases,
                                std::shared_ptr<const Map> map, const PushRunOptions& options,
                                const std::function<void(const Rearrange&)>& watch = {});

}  // namespace casepush
