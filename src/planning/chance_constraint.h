#pragma once

#include <optional>
#include <vector>

#include "push_risk.h"

namespace casepush {

/// What one push adds to a chain.
struct PushChance {
  double risk = 0.0;        ///< Of a collision, see riskOf().
  double recovery_s = 0.0;  ///< Expected time of recoveries, without the re-plans of its scatter.
};

/// The chance constraint of one search: bounds what a chain of pushes risks, and counts expected
/// recoveries as time. Every planner that knows chances asks it. Not thread-safe.
class ChanceConstraint {
 public:
  /// @param risk  Must outlive this.
  ChanceConstraint(const PushRisk& risk, double max_collision_probability, const Pose2& map_T_goal,
                   const GoalTolerance& tolerance);

  /// Expected time of the re-plans that the scatter of a push brings about, as the rest of the plan
  /// misses its goal for it [s].
  double driftS(int push) const { return drift_s_[push]; }

  /// What a push from a node of the search adds; nothing if the chain would risk too much.
  /// @param node_at  Gives the node of an id: its `map_T_object`, `parent` (negative for the
  ///   start), `push` and the `risk` of the pushes so far.
  template <typename NodeAt>
  std::optional<PushChance> judge(const NodeAt& node_at, int from, int push,
                                  const Pose2& map_T_end) {
    before_.clear();
    const auto wanted = static_cast<std::size_t>(risk_.pushesThatCount());
    for (int id = from; node_at(id).parent >= 0 && before_.size() < wanted;
         id = node_at(id).parent) {
      before_.push_back(node_at(id).push);
    }
    return judge(push, node_at(from).map_T_object, map_T_end, node_at(from).risk);
  }

 private:
  std::optional<PushChance> judge(int push, const Pose2& map_T_start, const Pose2& map_T_end,
                                  double risk_so_far) const;

  const PushRisk& risk_;
  double most_risk_;
  Pose2 map_T_goal_;
  GoalTolerance tolerance_;
  std::vector<double> drift_s_;  ///< Of each case.
  std::vector<int> before_;      ///< Scratch: the pushes so far, the last one first.
};

}  // namespace casepush
