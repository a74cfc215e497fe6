#pragma once

#include <optional>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/execution/exploration.h"

namespace casepush {

/// Where the robot starts a push in a direction of the object frame.
///
/// The robot faces the direction and moves along a line that passes the object's origin at
/// `offset_m` to its left. It starts where its true shape is `gap_m` short of touching the object,
/// also if it is a little beside the line.
/// @return  Nothing if the robot would pass the object without touching it.
std::optional<Pose2> contactStart(const Solid& object, const Solid& robot, double reach_m,
                                  double direction_rad, double offset_m, double gap_m);

/// Draws pushes to try, balanced against the outcomes known already.
class PushCandidates {
 public:
  PushCandidates(ObjectModel object, RobotModel robot, const ExplorationOptions& options);

  /// @param attempt   Different for each trial.
  /// @param failures  Trials in a row that were of no use: other gaps are tried.
  PushConfiguration draw(int attempt, int failures, const std::vector<Pose2>& outcomes) const;

  /// A pose up to 0.15 m behind the start of a push, as far as is free, from which the robot docks as
  /// it will when it executes plans: else its docking errors would be missing from what it learns.
  Pose2 runUp(const Pose2& object_T_start, double push_direction_rad) const;

 private:
  std::optional<PushConfiguration> tryDraw(Random& random, int failures,
                                           const std::vector<Pose2>& outcomes) const;

  ObjectModel object_;
  RobotModel robot_;
  ExplorationOptions options_;
};

}  // namespace casepush
