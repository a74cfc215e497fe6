#pragma once

#include <string>
#include <vector>

namespace casepush {

/// Ways of searching for a chain of cases.
enum class PlannerKind {
  kExpRrt,       ///< Exp-RRT with the choices of docs/planning.md.
  kExpRrtPaper,  ///< Exp-RRT close to the paper's print: similarity of eq. 3, all cases checked.
  kLattice,      ///< Weighted A* over hashed cells of SE(2), anytime.
  kOmplRrt,      ///< OMPL's stock control planners over the same cases and checks, for comparison.
  kOmplSst,
  kOmplEst,
  kOmplPdst,
  kOmplKpiece,
};

const std::vector<PlannerKind>& allPlannerKinds();

/// "exp_rrt", "exp_rrt_paper", "lattice", "ompl_rrt", ...
const char* toString(PlannerKind kind);

/// @throws InputError naming the planners that there are.
PlannerKind plannerKind(const std::string& name);

inline bool isOmpl(PlannerKind kind) { return kind >= PlannerKind::kOmplRrt; }

}  // namespace casepush
