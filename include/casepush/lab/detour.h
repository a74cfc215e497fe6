#pragma once

#include <cstdint>
#include <vector>

#include "casepush/lab/mean_interval.h"
#include "casepush/lab/task_experiment.h"

namespace casepush {

/// Tasks whose detour around the obstacles is about equally long, once with these fixed and once
/// with them pushed out of the way.
struct DetourBin {
  /// Shortest plan around the obstacles over the shortest one that needs not mind them.
  double from = 0.0;
  double to = 0.0;            ///< Not included.
  int pairs = 0;              ///< Both tasks succeeded; the means below are over these.
  int failed = 0;             ///< Pairs of which a task failed.
  double detour = 0.0;        ///< Mean.
  double around_m = 0.0;      ///< Mean of those shortest plans,
  double through_m = 0.0;     ///< in both cases.
  double stationary_s = 0.0;  ///< Mean time of a task with the obstacles fixed, and
  double movable_s = 0.0;     ///< pushed away, clearing included.
  MeanInterval ratio;         ///< The one over the other; bootstrap.
};

/// How much longer tasks take if obstacles are fixed, over the length of the detour: all tasks
/// first, then bins from 1, 1.25, 2, 3 and 4 on.
/// @param stationary  By task; with plans, and executed. @param movable  The same tasks.
std::vector<DetourBin> binByDetour(const std::vector<TaskRun>& stationary,
                                   const std::vector<TaskRun>& movable, std::uint64_t seed);

}  // namespace casepush
