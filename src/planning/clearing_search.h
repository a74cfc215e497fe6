#pragma once

#include <functional>
#include <vector>

#include "casepush/planning/push_checker.h"
#include "casepush/planning/push_time.h"

namespace casepush {

/// A search for pushes that bring an obstacle out of a way; everything must outlive it.
struct ClearingProblem {
  const std::vector<PreparedCase>& cases;  ///< Of the obstacle.
  const PushTime& time;                    ///< As if only the obstacle stood around.
  PushChecker& checker;                    ///< Of the obstacle among all that does not move now.
  Pose2 map_T_start;
  Pose2 map_T_robot;
  double spacing_m;  ///< Of two poses nearer than about this only the first one counts.
  double gyration_radius_m;
  int max_nodes;
  double wanted_m;  ///< Standing farther off than this is no better.
  double needed_m;  ///< Standing nearer to the way than this is still in it.
  std::function<double(const Pose2& map_T_obstacle)> way_distance_m;
  std::function<double(const Pose2& map_T_obstacle)> others_distance_m;  ///< From other obstacles.
  /// Expected time of push `next`, with the robot's way to it from push `previous` (-1: from where
  /// it stands); infinity if it cannot get there.
  std::function<double(const Pose2& map_T_obstacle, int previous, int next)> push_s;
  /// Expected time of the robot's way from its last push to where it is needed next.
  std::function<double(const Pose2& map_T_robot)> back_s;
};

struct ClearingChain {
  bool found = false;
  bool exhausted = false;   ///< Nothing was left to search.
  std::vector<int> pushes;  ///< Indices into the cases.
  double cost_s = 0.0;      ///< Expected time, without the way back.
  double back_s = 0.0;      ///< Of the way back.
  double distance_m = 0.0;  ///< Of the obstacle at its end from way and others, at its worst.
  int nodes = 0;
};

/// Expands the state lattice of the obstacle's cases until poses out of the way appear (paper
/// section 4, fig. 5), and takes the one of them that is farthest off; of those as far as wanted
/// the quickest. The paper expands breadth-first, and takes the farthest of those that appear
/// first. Here expected time comes first, with the robot's ways to the obstacle and back: nothing
/// that takes much longer than the quickest is looked at.
ClearingChain searchClearing(const ClearingProblem& problem, const std::function<bool()>& stop);

}  // namespace casepush
