#pragma once

#include <ompl/base/Planner.h>
#include <ompl/base/goals/GoalSampleableRegion.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "case_set.h"
#include "casepush/common/random.h"
#include "casepush/model/push_plan.h"
#include "casepush/planning/push_checker.h"
#include "casepush/planning/similarity.h"
#include "chance_constraint.h"
#include "edge_queue.h"
#include "goal_guide.h"
#include "push_start.h"
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
  double goal_bias = 0.8;          ///< Probability that the sample is the goal (paper: 0.95).
  int max_nodes = 50625;           ///< Paper section 6.
  double gyration_radius_m = 0.3;  ///< rho of the metric.
  double spacing_m = 0.1;          ///< Of nodes nearer than this only the cheaper grows.
  double greed = 3.0;              ///< Weight of the time that a push leaves to the goal.
  // While a solution is being improved:
  double improving_goal_bias = 0.5;  ///< In the place of goal_bias.
  double improving_greed = 2.0;      ///< In the place of greed.
  double improving_radius_m = 2.0;   ///< The cheapest node within up to this is extended.
  std::uint64_t seed = 1;
  /// In the place of the cases' sigma points, only with Similarity::kMetric; outlives the planner.
  ChanceConstraint* chance = nullptr;
};

/// Can the robot get to push `next` with the object at rest at `map_T_object`?
/// @param previous  The push that brought the object there; nullptr at the start.
using CanApproach = std::function<bool(const Pose2& map_T_object, const PreparedCase* previous,
                                       const PreparedCase& next)>;

/// Exp-RRT (paper algorithm 1): a rapidly exploring random tree whose edges are learnt pushes.
///
/// An OMPL planner over SE2StateSpace with a PushGoal. Departures from the printed algorithm, in
/// both modes: a (node, case) pair is tried once, an exhausted node leaves the search, and so does
/// a node to whose push the robot cannot get, which is asked before anything is pushed on from it.
/// With Similarity::kMetric also: of two nodes at nearly the same pose only the cheaper grows, and
/// no push is checked that would end where a cheaper one has; for a random sample cases are tried
/// in order of the distance of their outcome until the first safe one, at most six; for the goal
/// the pair of node and case is taken that promises the shortest time over the whole way (the guide
/// says what is left), and chains of up to three cases that end in the goal region are tried from
/// every new node. Once a solution is known, what cannot become cheaper is left out, and random
/// samples extend the cheapest node within a random radius. With Similarity::kPaper the node and
/// the case most similar by eq. 3 are taken, all cases of a node are checked. With chance
/// constraints a push is safe if its mean motion is and the chain up to it does not risk too much,
/// and expected recoveries count as time.
///
/// Each solve(), or search(), continues the tree until the next new solution, the termination
/// condition, or until nothing is left to try. Its own seed makes it reproducible; OMPL's random
/// numbers are not used.
class ExpRrt : public ompl::base::Planner {
 public:
  /// @param checker  Must outlive the planner; not shared with other threads while it solves.
  /// @param guide  To the goal, outlives the planner; nullptr: straight there.
  /// @param object_T_robot  Where the robot stands at the start.
  /// @param can_approach  Empty: it always can.
  ExpRrt(const ompl::base::SpaceInformationPtr& space, PushChecker* checker,
         std::shared_ptr<const CaseSet> cases, GoalGuide* guide, const Pose2& object_T_robot,
         CanApproach can_approach, const ExpRrtOptions& options);
  ~ExpRrt() override;

  void setProblemDefinition(const ompl::base::ProblemDefinitionPtr& problem) override;
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  /// The same without adding a solution to the problem's definition.
  /// @param stop  Asked often.
  /// @return  False if there is no valid start.
  bool search(const std::function<bool()>& stop);
  void clear() override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

  const PushTree& tree() const { return tree_; }
  const std::vector<PreparedCase>& cases() const { return set_->cases; }
  const std::shared_ptr<const CaseSet>& caseSet() const { return set_; }

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

  /// Where a push from a node leads, and when [s].
  struct Outlook {
    Eigen::Vector2d end_m;
    double end_yaw_rad;
    double cost_s;
    std::uint64_t cell;
    int push;
  };

  bool start();
  Growth grow();
  Growth growToGoal();
  Growth growToSample(const Pose2& pose);
  Growth growAndConnect(int node, int push);
  Target sample();
  bool isImproving() const { return !solutions_.empty(); }
  bool mustStop(std::size_t work);
  std::optional<EdgeQueue::Edge> chooseEdge();
  std::optional<Outlook> lookAgain(const EdgeQueue::Edge& edge);
  int selectOpen(const Pose2& target);
  int selectCheapestNear(const Pose2& target);
  int selectMostSimilar(const Pose2& target) const;
  Outlook outlook(int node, int push, const PushStart& start) const;
  void noteEdges(int node);
  void noteAllEdges();
  int chooseCase(int node, const Pose2& target);
  int chooseCaseChecked(int node, const Pose2& target);
  bool isReachable(int node);
  bool isPointless(int node, const Outlook& outlook);
  bool isSafe(int node, int push);
  bool isSafeByChance(int node, int push);
  Growth extend(int node, int push, int* added = nullptr);
  Growth addSolution(int node);
  Growth connect(int node);
  Growth follow(int node, const CaseChain& chain);
  double pushCost(int node, int push) const;
  double chainCost(int node, const CaseChain& chain) const;
  double remaining(const Eigen::Vector2d& position_m) const;
  GoalGuide::Way wayToGoal(const Eigen::Vector2d& position_m, bool exactly) const;
  EdgeQueue::Push weigh(const Outlook& outlook, bool exactly) const;
  bool isInGoal(const Eigen::Vector2d& position_m, double yaw_rad) const;
  bool isHopeless(double cost_s, const Eigen::Vector2d& position_m) const;
  void addSolutionPath(int node);
  void freeDataStates() const;

  PushChecker* checker_;
  std::shared_ptr<const CaseSet> set_;
  GoalGuide* guide_;
  Pose2 object_T_robot_;
  CanApproach can_approach_;
  ExpRrtOptions options_;
  Eigen::Vector2d min_m_;
  Eigen::Vector2d max_m_;
  PushTree tree_;
  Random random_;
  const PushGoal* goal_ = nullptr;
  const std::function<bool()>* stop_ = nullptr;  // of the call of search()
  std::vector<int> solutions_;
  double best_cost_s_;
  int extension_count_ = 0;
  std::size_t work_ = 0;             // cases looked at since somebody was asked whether to stop
  PushChance last_chance_;           // of the push that isSafe() last found safe
  std::vector<bool> is_approached_;  // nodes whose push the robot can get to
  EdgeQueue edges_;                  // untried ones of each open node, and some that are no longer
  bool must_note_all_ = false;       // before the next one is taken
  std::vector<int> nearby_;          // scratch
  std::vector<std::pair<double, int>> order_;  // scratch
  std::vector<Outlook> outlooks_;              // scratch
  std::vector<EdgeQueue::Push> noted_;         // scratch
  std::vector<const CaseChain*> endings_;      // scratch
  mutable std::vector<ompl::base::State*> data_states_;
};

}  // namespace casepush
