#pragma once

#include <cstdint>
#include <vector>

#include "casepush/lab/mean_interval.h"
#include "casepush/lab/task_experiment.h"

namespace casepush {

/// The same task with the obstacles fixed and with them pushed out of the way.
struct ObstaclePair {
  std::uint64_t seed = 0;
  double around_m = 0.0;   ///< Shortest plan around the obstacles, and
  double through_m = 0.0;  ///< shortest that needs not mind them; infinity if there is none.
  double stationary_s = 0.0;
  double movable_s = 0.0;
  bool succeeded = false;  ///< Both.

  /// Their ratio; infinity without a plan.
  double detour() const;
};

/// @param stationary  By task; with plans, and executed. @param movable  The same tasks.
std::vector<ObstaclePair> obstaclePairs(const std::vector<TaskRun>& stationary,
                                        const std::vector<TaskRun>& movable);

/// Tasks whose detour around the obstacles is about equally long, once with these fixed and once
/// with them pushed out of the way.
struct DetourBin {
  double from = 0.0;          ///< Detours from this one
  double to = 0.0;            ///< to this one, which is not included.
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
std::vector<DetourBin> binByDetour(const std::vector<ObstaclePair>& pairs, std::uint64_t seed);

}  // namespace casepush
