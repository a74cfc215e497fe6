#pragma once

#include <functional>
#include <vector>

#include "casepush/planning/push_checker.h"
#include "casepush/planning/push_time.h"

namespace casepush {

/// A search for pushes that bring an obstacle out of a way; everything must outlive it.
struct ClearingProblem {
  const std::vector<PreparedCase>& cases;  ///< Of the obstacle.
  const PushTime& time;
  PushChecker& checker;  ///< Of the obstacle among all that does not move now.
  Pose2 map_T_start;
  Pose2 map_T_robot;
  double spacing_m;  ///< Of two poses nearer than about this only the first one counts.
  double gyration_radius_m;
  int max_nodes;
  double wanted_m;  ///< Standing farther off than this is no better.
  double needed_m;  ///< Standing nearer to the way than this is still in it.
  std::function<double(const Pose2& map_T_obstacle)> way_distance_m;
  std::function<double(const Pose2& map_T_obstacle)> others_distance_m;  ///< From other obstacles.
  /// Can the robot get from push `previous` (-1: from where it stands) to push `next`?
  std::function<bool(const Pose2& map_T_obstacle, int previous, int next)> can_approach;
};

struct ClearingChain {
  bool found = false;
  bool exhausted = false;   ///< Nothing was left to search.
  std::vector<int> pushes;  ///< Indices into the cases.
  double cost_s = 0.0;      ///< Expected time.
  double distance_m = 0.0;  ///< Of the obstacle at its end from way and others, at its worst.
  int nodes = 0;
};

/// Expands the state lattice of the obstacle's cases breadth-first until poses out of the way
/// appear (paper section 4, fig. 5), and takes the one of them that is farthest off; of those as
/// far as wanted the cheapest.
ClearingChain searchClearing(const ClearingProblem& problem, const std::function<bool()>& stop);

}  // namespace casepush
