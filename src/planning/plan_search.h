#pragma once

#include <ompl/base/ProblemDefinition.h>

#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "approach_check.h"
#include "case_set.h"
#include "casepush/planning/push_planner.h"
#include "chance_constraint.h"
#include "disposal.h"
#include "exp_rrt.h"
#include "goal_guide.h"
#include "patience.h"
#include "search_spaces.h"

namespace casepush {

/// Ends a search: somebody's wish or a time limit. Tells how far it has come.
class SearchClock {
 public:
  SearchClock(double deadline_s, std::function<bool()> stop,
              std::function<void(const PlanProgress&)> report = {});

  bool isCancelled() const;
  /// True once cancelled or `share` of the time until the deadline has passed.
  bool isOver(double share = 1.0) const;
  double elapsedS() const;
  /// Asks for the whole time. Must not outlive this.
  Patience patience() const;

  /// Reports if a while has passed since the last report or the best cost went down.
  /// @param nodes  Of the present search.
  void report(int nodes, double best_cost_s) const;
  /// Nodes of searches that ended, to which those of the next one are added.
  void addNodes(int nodes) const { nodes_ += nodes; }

 private:
  std::chrono::steady_clock::time_point begin_;
  double deadline_s_;
  std::function<bool()> stop_;
  std::function<void(const PlanProgress&)> report_;
  mutable int nodes_ = 0;
  mutable double reported_s_ = 0.0;
  mutable double reported_cost_s_ = std::numeric_limits<double>::infinity();
};

/// What a search works with; all must outlive it.
struct SearchProblem {
  const PlanRequest& request;
  const std::vector<const Case*>& cases;  ///< All of the request's object, at least one.
  const ObjectModel& object;
  const RobotModel& robot;
  const PushPlannerOptions& options;
  const RobotPathPlanner& paths;
  const std::vector<PlacedSolid>& obstacles;
  /// False if it was stopped.
  std::function<bool(std::vector<PreparedCase>*, const Patience&)> attach_sweeps;
  ApproachLibrary* approaches;
  const ClearanceGrid& travel;  ///< Of the map, for the robot.
  CaseSetLibrary* case_sets;
  SearchSpaces* spaces;
  Disposal* disposal;
};

/// Exp-RRT as it is by default, with a metric: of nodes near to one another only one grows.
bool isMetricExpRrt(const PushPlannerOptions& options);

/// Whether plans made with these options keep out of dead ends where they can (DeadEndCheck).
bool keepsOutOfDeadEnds(const PushPlannerOptions& options);

/// Decides whether the robot can get from push to push.
class ApproachVerifier {
 public:
  /// @param stop  Asked often; once it says true, the robot gets nowhere from afar.
  /// @param owner  As of ApproachCheck.
  ApproachVerifier(const SearchProblem& problem, const CollisionChecker& checker,
                   std::function<bool()> stop, const std::shared_ptr<const void>& owner = nullptr);

  /// @param previous  The push that brought the object to `map_T_object`; nullptr for the first.
  bool canApproach(const Pose2& map_T_object, const PreparedCase* previous,
                   const PreparedCase& next);

  /// The same without looking for ways that take long to find.
  bool canApproachSimply(const Pose2& map_T_object, const PreparedCase* previous,
                         const PreparedCase& next);

  /// Why the robot could not get to the last push that it could not get to; empty if none.
  const std::string& problem() const { return explanation_; }

 private:
  const SearchProblem& problem_;
  std::function<bool()> stop_;
  ApproachCheck quick_;
  CollisionChecker checker_;
  std::string explanation_;
};

/// The request's cases, ready for a search with one spread of sigma points; nullptr if the clock
/// ran out. What is kept is not looked at again.
/// @throws InputError for a case that validateCase() refuses.
std::shared_ptr<const CaseSet> caseSetFor(const SearchProblem& problem, const PushChecker& checker,
                                          double zeta, const SearchClock& clock);

/// The chance constraint of one search and what it needs, if its safety level asks for one.
class SearchChance {
 public:
  /// @param cases  Of the problem; they and the checker must outlive this.
  SearchChance(const SearchProblem& problem, const std::vector<PreparedCase>& cases,
               PushChecker* checker, const SafetyLevel& safety);
  SearchChance(const SearchChance&) = delete;
  SearchChance& operator=(const SearchChance&) = delete;

  /// nullptr: sigma points.
  ChanceConstraint* constraint() { return constraint_ ? &*constraint_ : nullptr; }
  const PushRisk* risk() const { return risk_ ? &*risk_ : nullptr; }

 private:
  std::optional<PushRisk> risk_;
  std::optional<ChanceConstraint> constraint_;
};

/// The plan of a chain of cases (indices), with its collision probabilities if there is `risk`.
PushPlan planOf(const PlanRequest& request, const std::vector<PreparedCase>& cases,
                const std::vector<int>& pushes, const SafetyLevel& safety,
                const PushRisk* risk = nullptr);

/// How it is decided whether the robot can get to a push.
enum class Approaches {
  kSimple,    ///< While the tree grows, by a quick check that may miss a way.
  kThorough,  ///< For each push of a solution, by RobotPathPlanner.
};

class DeadEndCheck;

/// One search with one safety level: grows an Exp-RRT and compares its solutions by
/// expected time. The robot can get to every push of the result. Where plans are improved, those
/// that may get the object stuck (DeadEndCheck) are taken only if no other was found.
class PlanSearch {
 public:
  /// All must outlive it.
  PlanSearch(const SearchProblem& problem, PushChecker* checker, const SafetyLevel& safety,
             std::shared_ptr<const CaseSet> cases, GoalGuide* guide, Approaches approaches,
             const SearchClock& clock);
  ~PlanSearch();

  enum class End { kFound, kExhausted, kNodeLimit, kStopped, kCutOff };
  End run();

  /// What it found, once. @pre run() returned kFound.
  struct Solution {
    PushPlan plan;
    double expected_s = 0.0;
    int dead_end = 0;  ///< As PlanResult::dead_end.
  };
  Solution takeSolution() { return std::move(*solution_); }
  const ExpRrt& rrt() const { return rrt_; }

  /// Was a push turned down because the robot may not get to it?
  bool hasRejected() const { return has_rejected_; }
  /// Why the robot could not get to a push of a rejected plan; empty if none was rejected.
  const std::string& approachProblem() const { return approaches_.problem(); }
  /// Where the way of the object is too narrow, if run() returned kCutOff; empty if that is not
  /// known.
  const std::string& narrowPlace() const { return narrow_place_; }

 private:
  CanApproach simpleApproach();
  bool findFirst();
  bool mayBeMissing() const;
  bool isCutOff();
  bool isOver(double share) const;  ///< Reports, too.
  bool isLate() const { return clock_.isOver(safety_.deadline_share); }
  void improve();
  /// The first node of the chain that the robot cannot push to; -1 if there is none; nothing if
  /// the clock ran out.
  std::optional<int> findUnreachable(const std::vector<int>& chain);
  bool canApproach(int node);
  /// Where in the chain the object may get stuck first; -1 if nowhere.
  int findDeadEnd(const std::vector<int>& chain);
  Solution solutionOf(const std::vector<int>& chain, int dead_end) const;
  End endWithout();

  const SearchProblem& problem_;
  const SearchClock& clock_;
  SafetyLevel safety_;
  SearchChance chance_;
  std::unique_ptr<SearchSpace> space_;
  ompl::base::ProblemDefinitionPtr definition_;
  ExpRrt rrt_;
  PushChecker* checker_;
  Approaches approaches_how_;
  ApproachVerifier approaches_;
  bool has_rejected_ = false;
  std::vector<int> approachable_;            // nodes whose push the robot can get to
  std::unique_ptr<DeadEndCheck> dead_ends_;  // nothing where plans are not improved
  std::vector<int> open_ended_;              // nodes in which the object does not get stuck
  int dead_end_count_ = 0;
  std::optional<bool> is_cut_off_;  // nothing until it was looked for
  std::string narrow_place_;
  std::int64_t improvement_end_ = 0;  // extensions, from the first solution on
  std::optional<Solution> solution_;
};

}  // namespace casepush
