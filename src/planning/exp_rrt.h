#pragma once

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/push_plan.h"
#include "casepush/planning/push_checker.h"
#include "casepush/planning/push_time.h"
#include "casepush/planning/similarity.h"
#include "push_tree.h"

namespace casepush {

/// The goal region of a push task for OMPL. Distance 1 is its border.
class PushGoal : public ompl::base::GoalSampleableRegion {
 public:
  PushGoal(const ompl::base::SpaceInformationPtr& space, const Pose2& map_T_goal,
           const GoalTolerance& tolerance);

  double distanceGoal(const ompl::base::State* state) const override;
  void sampleGoal(ompl::base::State* state) const override;  ///< Always the goal itself.
  unsigned int maxSampleCount() const override { return 1; }

  const Pose2& pose() const { return map_T_goal_; }
  const GoalTolerance& tolerance() const { return tolerance_; }

 private:
  Pose2 map_T_goal_;
  GoalTolerance tolerance_;
};

struct ExpRrtOptions {
  Similarity similarity = Similarity::kMetric;
  double goal_bias = 0.2;          ///< Probability that the sample is the goal (paper: 0.95).
  int max_nodes = 50625;           ///< Paper section 6.
  double gyration_radius_m = 0.3;  ///< rho of the metric.
  double spacing_m = 0.1;          ///< Of nodes nearer than this only the cheaper grows.
  // While a solution is being improved, besides:
  double improving_goal_bias = 0.5;  ///< In the place of goal_bias.
  double improving_radius_m = 2.0;   ///< The cheapest node within up to this is extended.
  double greed = 2.0;                ///< Weight of the time that a node still needs to the goal.
  std::uint64_t seed = 1;
};

/// Exp-RRT (paper algorithm 1): a rapidly exploring random tree whose edges are learnt pushes.
///
/// An OMPL planner over SE2StateSpace with a PushGoal. Departures from the printed algorithm, in
/// both modes: a (node, case) pair is tried once and an exhausted node leaves the search.
/// With Similarity::kMetric also: cases are tried in order of the distance of their outcome to the
/// sample until the first safe one; not the nearest node is extended but the cheapest within a
/// random radius; of two nodes at nearly the same pose only the cheaper grows. Once a solution is
/// known, what cannot become cheaper is left out, and goal samples extend the node that promises
/// the shortest time over the whole way. With Similarity::kPaper the node and the case most similar
/// by eq. 3 are taken, all cases of a node are checked.
///
/// Each solve() continues the tree until the next new solution, the termination condition, or until
/// nothing is left to try. Its own seed makes it reproducible; OMPL's random numbers are not used.
class ExpRrt : public ompl::base::Planner {
 public:
  /// @param checker  Must outlive the planner; not shared with other threads while it solves.
  /// @param object_T_robot  Where the robot stands at the start.
  ExpRrt(const ompl::base::SpaceInformationPtr& space, PushChecker* checker,
         std::vector<PreparedCase> cases, const PushTime& time, const Pose2& object_T_robot,
         const ExpRrtOptions& options);
  ~ExpRrt() override;

  void setProblemDefinition(const ompl::base::ProblemDefinitionPtr& problem) override;
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void clear() override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

  const PushTree& tree() const { return tree_; }
  const std::vector<PreparedCase>& cases() const { return cases_; }

  /// Extensions attempted so far: the deterministic measure of work.
  int extensionCount() const { return extension_count_; }

  /// Goal nodes of the tree, the cheapest first.
  const std::vector<int>& solutions() const { return solutions_; }

  /// Nodes from the start to `node`, both inclusive.
  std::vector<int> chain(int node) const;

  /// Removes a node that cannot be reached after all, and all below it; the search may go on.
  void reject(int node);

 private:
  enum class Growth { kNothing, kSolution, kExhausted };

  struct Target {
    Pose2 pose;
    bool is_goal;
  };

  bool start();
  Growth grow();
  Target sample();
  bool isImproving(const Target& target) const { return target.is_goal && !solutions_.empty(); }
  int select(const Target& target);
  int selectCheapestNear(const Pose2& target);
  int selectMostPromising();
  int selectMostSimilar(const Pose2& target) const;
  void notePromise(int node);
  int chooseCase(int node, const Target& target);
  int chooseCaseChecked(int node, const Pose2& target);
  Growth extend(int node, int push);
  double pushCost(int node, int push) const;
  double remaining(const Pose2& pose) const;
  void addSolutionPath(int node);
  void freeDataStates() const;

  PushChecker* checker_;
  std::vector<PreparedCase> cases_;
  PushTime time_;
  Pose2 object_T_robot_;
  ExpRrtOptions options_;
  Eigen::Vector2d min_m_;
  Eigen::Vector2d max_m_;
  PushTree tree_;
  Random random_;
  const PushGoal* goal_ = nullptr;
  std::vector<int> solutions_;
  double best_cost_s_;
  int extension_count_ = 0;
  // (expected time over the whole way, node), the least first; also nodes that closed meanwhile.
  using Promise = std::pair<double, int>;
  std::priority_queue<Promise, std::vector<Promise>, std::greater<>> promising_;
  std::vector<int> nearby_;                    // scratch
  std::vector<std::pair<double, int>> order_;  // scratch
  mutable std::vector<ompl::base::State*> data_states_;
};

}  // namespace casepush
