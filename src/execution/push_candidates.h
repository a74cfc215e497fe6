#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/execution/displacement_coverage.h"
#include "casepush/execution/exploration.h"
#include "push_predictor.h"

namespace casepush {

/// Where the robot starts a push in a direction of the object frame.
///
/// The robot faces the direction and moves along a line that passes the object's origin at
/// `offset_m` to its left. It starts where its true shape is `gap_m` short of touching the object,
/// also if it is a little beside the line.
/// @return  Nothing if the robot would pass the object without touching it.
std::optional<Pose2> contactStart(const Solid& object, const Solid& robot, double reach_m,
                                  double direction_rad, double offset_m, double gap_m);

/// Draws pushes to try for the first time.
class PushCandidates {
 public:
  PushCandidates(ObjectModel object, RobotModel robot, const ExplorationOptions& options);

  /// True if a push may be tried where the object stands now, given its rough outcome.
  using Filter = std::function<bool(const PushConfiguration& push, const Pose2& start_T_predicted)>;

  /// @param attempt   Different for each trial.
  /// @param outcomes  Known already; with Coverage::kSpread the push that promises to add most is
  ///   drawn.
  /// @return  Nothing if no push passes the filter.
  std::optional<PushConfiguration> draw(int attempt, const std::vector<Pose2>& outcomes,
                                        const Filter& filter) const;

  /// A push straight at the object's centre towards a direction in the object frame.
  std::optional<PushConfiguration> plainPush(double direction_rad) const;

  Pose2 predict(const PushConfiguration& push) const { return predictor_.predict(push); }
  /// Improves later predictions.
  void learn(const PushConfiguration& push, const Pose2& start_T_object) {
    predictor_.learn(push, start_T_object);
  }

  /// A pose up to 0.15 m behind the start of a push, as far as is free, from which the robot docks
  /// as it will when it executes plans: else its docking errors would be missing from what it
  /// learns.
  Pose2 runUp(const Pose2& object_T_start, double push_direction_rad) const;

 private:
  std::optional<PushConfiguration> tryDraw(Random& random) const;
  std::optional<PushConfiguration> at(double direction_rad, double offset_m) const;

  ObjectModel object_;
  RobotModel robot_;
  ExplorationOptions options_;
  PushPredictor predictor_;
};

/// The displacements that the pushes of an exploration should cover.
DisplacementCoverage::Region coverageRegion(const ExplorationOptions& options);

}  // namespace casepush
