#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "casepush/lab/push_run.h"

namespace casepush {

/// One plan for a problem, not executed.
struct PlanTrial {
  bool is_solved = false;
  double length_m = 0.0;    ///< Of the object's way.
  double expected_s = 0.0;  ///< Of its execution, clearing not counted.
  int pushes = 0;
  int nodes = 0;            ///< Poses of the object that were reached.
  double planning_s = 0.0;  ///< CPU time.
};

/// Plans for the same problem with different seeds (Fig. 11 of the paper). Other objects are fixed,
/// or, with `options.clear_obstacles`, those with known cases are as if they were not there, as in
/// the first plan of a task that may push them away. What a planner prepares for a map is in none
/// of the times: a plan before them does it.
std::vector<PlanTrial> planTrials(const Catalog& catalog, const PushProblem& problem,
                                  const std::vector<Case>& cases, std::shared_ptr<const Map> map,
                                  const PushRunOptions& options, int count, std::uint64_t seed);

/// The shortest of the ways found [m]; infinity if there is none.
double shortestM(const std::vector<PlanTrial>& plans);

}  // namespace casepush
