#include "chain_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cut_off.h"
#include "origin_distance.h"

namespace casepush {
namespace {

constexpr int kAttempts = 30;

/// A push that the robot cannot get to.
struct Ban {
  Pose2 map_T_object;
  int previous;
  int push;

  bool operator==(const Ban& other) const {
    return map_T_object.x() == other.map_T_object.x() &&
           map_T_object.y() == other.map_T_object.y() &&
           map_T_object.yaw() == other.map_T_object.yaw() && previous == other.previous &&
           push == other.push;
  }
};

ChainPlan planChain(const SearchProblem& problem, const CaseSet& set, PushChecker* checker,
                    const SafetyLevel& safety, const SearchClock& clock) {
  const PlanRequest& request = problem.request;
  ChainPlan made;
  made.end = PlanSearch::End::kStopped;
  const std::vector<PreparedCase>& cases = set.cases;
  const PushTime& time = set.time;
  SearchChance chance(problem, cases, checker, safety);
  const bool is_lattice = problem.options.planner == PlannerKind::kLattice;
  // Without obstacles, which fill cells that they only touch: that would be no lower bound.
  const OriginDistance map(*checker->collisions().mapColumns(), problem.object.solid,
                           request.map_T_goal.position(), request.tolerance.position_m,
                           clock.patience());
  if (!std::isfinite(map.at(request.object.map_T_object.position()))) {
    made.end = PlanSearch::End::kCutOff;
    return made;
  }
  LatticeOptions lattice;
  if (problem.options.improvement_extensions == 0) lattice.weights.resize(1);
  if (request.tolerance.isMet(request.map_T_goal, request.object.map_T_object)) {
    made.end = PlanSearch::End::kFound;
    made.plan = planOf(request, cases, {}, safety, chance.risk());
    made.nodes = 1;
    return made;
  }
  ApproachVerifier approaches(problem, checker->collisions(), [&clock] { return clock.isOver(); });
  std::vector<Ban> banned;
  const auto stop = [&clock, &made, &safety] {
    clock.report(made.nodes, std::numeric_limits<double>::infinity());
    return clock.isOver(safety.deadline_share);
  };
  for (int attempt = 0; attempt < kAttempts && !stop(); ++attempt) {
    const ChainProblem chain{cases,
                             time,
                             *checker,
                             request.object.map_T_object,
                             request.map_T_goal,
                             request.tolerance,
                             request.map_T_robot,
                             problem.object.gyration_radius_m,
                             problem.options.max_nodes,
                             request.seed,
                             problem.options.time.handling_s,
                             chance.constraint()};
    const auto is_banned = [&banned](const Pose2& pose, int previous, int push) {
      return std::find(banned.begin(), banned.end(), Ban{pose, previous, push}) != banned.end();
    };
    const ChainResult result =
        is_lattice ? searchLattice(chain, lattice, map, is_banned, stop, problem.disposal)
                   : searchWithOmpl(problem.options.planner, chain, stop, problem.disposal);
    made.nodes += result.nodes;
    if (!result.found) {
      made.end = stop()             ? PlanSearch::End::kStopped
                 : result.exhausted ? PlanSearch::End::kExhausted
                                    : PlanSearch::End::kNodeLimit;
      return made;
    }
    Pose2 pose = request.object.map_T_object;
    int previous = -1;
    bool reachable = true;
    for (const int push : result.pushes) {
      if (!approaches.canApproach(pose, previous < 0 ? nullptr : &cases[previous], cases[push])) {
        banned.push_back({pose, previous, push});
        reachable = false;
        break;
      }
      pose = pose * cases[push].start_outcome.mean;
      previous = push;
    }
    if (!reachable) continue;
    made.end = PlanSearch::End::kFound;
    made.plan = planOf(request, cases, result.pushes, safety, chance.risk());
    made.expected_s = result.cost_s;
    made.bound = result.bound;
    return made;
  }
  made.approach_problem = approaches.problem();
  made.end = stop() ? PlanSearch::End::kStopped : PlanSearch::End::kExhausted;
  return made;
}

}  // namespace

ChainPlan planChain(const SearchProblem& problem, PushChecker* checker, const SafetyLevel& safety,
                    const SearchClock& clock) {
  std::shared_ptr<const CaseSet> set = caseSetFor(problem, *checker, safety.zeta, clock);
  if (set == nullptr) {
    ChainPlan late;
    late.end = PlanSearch::End::kStopped;
    return late;
  }
  ChainPlan made = planChain(problem, *set, checker, safety, clock);
  if (made.end == PlanSearch::End::kNodeLimit || made.end == PlanSearch::End::kExhausted) {
    CutOff cut_off = findCutOff(problem, checker, set->cases, clock);
    if (cut_off.is_certain) made.end = PlanSearch::End::kCutOff;
    made.narrow_place = std::move(cut_off.where);
  }
  problem.disposal->take(std::move(set));  // There may be thousands of cases.
  return made;
}

}  // namespace casepush
