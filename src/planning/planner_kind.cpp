#include "casepush/planning/planner_kind.h"

#include "casepush/common/input_error.h"

namespace casepush {

const std::vector<PlannerKind>& allPlannerKinds() {
  static const std::vector<PlannerKind> kAll = {PlannerKind::kExpRrt,   PlannerKind::kExpRrtPaper,
                                                PlannerKind::kLattice,  PlannerKind::kOmplRrt,
                                                PlannerKind::kOmplSst,  PlannerKind::kOmplEst,
                                                PlannerKind::kOmplPdst, PlannerKind::kOmplKpiece};
  return kAll;
}

const char* toString(PlannerKind kind) {
  switch (kind) {
    case PlannerKind::kExpRrt:
      return "exp_rrt";
    case PlannerKind::kExpRrtPaper:
      return "exp_rrt_paper";
    case PlannerKind::kLattice:
      return "lattice";
    case PlannerKind::kOmplRrt:
      return "ompl_rrt";
    case PlannerKind::kOmplSst:
      return "ompl_sst";
    case PlannerKind::kOmplEst:
      return "ompl_est";
    case PlannerKind::kOmplPdst:
      return "ompl_pdst";
    case PlannerKind::kOmplKpiece:
      return "ompl_kpiece";
  }
  return "unknown";
}

PlannerKind plannerKind(const std::string& name) {
  std::string known;
  for (const PlannerKind kind : allPlannerKinds()) {
    if (name == toString(kind)) return kind;
    known += (known.empty() ? "" : ", ") + std::string(toString(kind));
  }
  throw InputError("planner", "\"" + name + "\" is unknown; known are: " + known);
}

}  // namespace casepush
