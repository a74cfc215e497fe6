#pragma once

#include "chain_search.h"
#include "plan_search.h"

namespace casepush {

/// What a search other than Exp-RRT came to.
struct ChainPlan {
  PlanSearch::End end = PlanSearch::End::kExhausted;
  PushPlan plan;
  double expected_s = 0.0;
  double bound = 0.0;  ///< See ChainResult.
  int nodes = 0;
  std::string approach_problem;
  std::string narrow_place;  ///< As PlanSearch::narrowPlace().
};

/// Searches with the lattice or an OMPL planner until the robot can get to every push of a chain.
ChainPlan planChain(const SearchProblem& problem, PushChecker* checker, const SafetyLevel& safety,
                    const SearchClock& clock);

}  // namespace casepush
