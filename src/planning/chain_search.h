#pragma once

#include <functional>
#include <vector>

#include "casepush/model/push_plan.h"
#include "casepush/planning/planner_kind.h"
#include "casepush/planning/push_checker.h"
#include "casepush/planning/push_time.h"
#include "chance_constraint.h"

namespace casepush {

class Disposal;
class OriginDistance;

/// A search for a chain of cases; everything must outlive it.
struct ChainProblem {
  const std::vector<PreparedCase>& cases;
  const PushTime& time;
  PushChecker& checker;
  Pose2 map_T_start;
  Pose2 map_T_goal;
  GoalTolerance tolerance;
  Pose2 map_T_robot;
  double gyration_radius_m;
  int max_nodes;
  std::uint64_t seed;
  double handling_s;                   ///< No push takes less than this and its duration.
  ChanceConstraint* chance = nullptr;  ///< In the place of the cases' sigma points.
};

struct ChainResult {
  bool found = false;
  bool exhausted = false;   ///< Nothing was left to search.
  std::vector<int> pushes;  ///< Indices into the cases.
  double cost_s = 0.0;      ///< Expected time.
  double bound = 0.0;       ///< The cost is at most this times the best one's; 0: no bound known.
  int nodes = 0;            ///< Poses reached; with OMPL every safe push that it tried.
};

/// One of OMPL's stock control planners with the case as the control. Its random numbers are
/// OMPL's: only the first seed of a process counts.
/// @param disposal  Frees its tree, which takes up to three tenths of the time that it grew.
ChainResult searchWithOmpl(PlannerKind kind, const ChainProblem& problem,
                           const std::function<bool()>& stop, Disposal* disposal);

struct LatticeOptions {
  double cell_m = 0.1;  ///< Of the position; the yaw's is cell_m / gyration radius.
  std::vector<double> weights = {5.0, 2.5, 1.5, 1.0};  ///< Of the heuristic, falling.
};

/// ARA* (Likhachev et al. 2003) over cells of SE(2), of which each keeps the cheapest pose that
/// reached it; edges are checked for collisions and risks when their turn comes (Cohen et al.
/// 2014).
///
/// The search with one weight goes on where the one before it ended, until `stop` says true or
/// `max_nodes` are reached; the best chain so far is returned with the bound that was proven for
/// it, over the graph of the cells' poses. The cost is time, and with `chance` the expected time of
/// recoveries; nothing is random.
/// @param map  Of the goal.
/// @param is_banned  Edges (pose, previous case or -1, case) that must not be used.
/// @param disposal  Frees what has grown.
ChainResult searchLattice(const ChainProblem& problem, const LatticeOptions& options,
                          const OriginDistance& map,
                          const std::function<bool(const Pose2&, int, int)>& is_banned,
                          const std::function<bool()>& stop, Disposal* disposal);

}  // namespace casepush
