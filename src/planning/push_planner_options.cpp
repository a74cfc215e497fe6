#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "casepush/planning/push_planner.h"

namespace casepush {

PushPlannerOptions PushPlannerOptions::forPlanner(PlannerKind kind) {
  PushPlannerOptions options;
  options.planner = kind;
  if (kind == PlannerKind::kExpRrtPaper) {
    options.similarity = Similarity::kPaper;
    options.goal_bias = 0.95;
  }
  return options;
}

void PushPlannerOptions::improveUntilDeadline() {
  solutions = std::numeric_limits<int>::max();
  improvement_extensions = std::numeric_limits<int>::max();
}

void PushPlannerOptions::validate() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Violations violations;
  violations.require("goal_bias", goal_bias, 0.0, 1.0);
  violations.require("max_nodes", max_nodes, 1, 10000000);
  violations.require("zeta", zeta, 0.0, 10.0);
  violations.require("object_margin_m", object_margin_m, 0.0, 1.0);
  violations.require("robot_margin_m", robot_margin_m, 0.0, 1.0);
  violations.require("solutions", solutions, 1, kInfinity);
  violations.require("improvement_extensions", improvement_extensions, 0, kInfinity);
  violations.requirePositive("spacing_m", spacing_m, 1.0);
  violations.requirePositive("risk.max_collision_probability", risk.max_collision_probability, 1.0);
  violations.require("risk.horizon", risk.horizon, 1, 1000);
  violations.require("risk.recovery_s", risk.recovery_s, 0.0, 3600.0);
  violations.require("mask_memory_mb", mask_memory_mb, 0, 100000);
  violations.requirePositive("time.drive_speed_mps", time.drive_speed_mps, kInfinity);
  violations.requirePositive("time.turn_rate_rps", time.turn_rate_rps, kInfinity);
  violations.require("time.clearance_m", time.clearance_m, 0.0, kInfinity);
  violations.require("time.handling_s", time.handling_s, 0.0, kInfinity);
  violations.throwIfAny("push planner options");
  const bool knows_chance = planner == PlannerKind::kLattice ||
                            (planner == PlannerKind::kExpRrt && similarity == Similarity::kMetric);
  if (risk.model == RiskModel::kChance && !knows_chance) {
    throw InputError("risk", std::string("planner ") + toString(planner) +
                                 " knows no chance constraints; use lattice or exp_rrt");
  }
}

}  // namespace casepush
