#pragma once

#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/push_plan.h"

namespace casepush {

/// Distance of two displacements in units of a goal's tolerance: 1 where a task just succeeds.
double toleranceDistance(const Pose2& a, const Pose2& b, const GoalTolerance& tolerance = {});

/// How well a few displacements stand for all those that a planner may need.
///
/// Wanted displacements go in all directions, `min_m` to `max_m` far, and turn by up to `max_yaw`;
/// a fixed low-discrepancy set of them stands for all. The measure is the mean toleranceDistance
/// from a wanted displacement to the nearest one that is there (greedy choice of what lowers it
/// most is within 1 - 1/e of the best choice, as for every k-median gain).
class DisplacementCoverage {
 public:
  struct Region {
    double min_m = 0.1;
    double max_m = 0.8;
    double max_yaw_rad = 1.2;
  };

  DisplacementCoverage() : DisplacementCoverage(Region{}) {}
  explicit DisplacementCoverage(const Region& region);

  void add(const Pose2& start_T_object);
  /// By how much one more displacement would lower meanDistance().
  double gain(const Pose2& start_T_object) const;
  /// Of the wanted displacements; that of the displacement zero counts as there from the beginning.
  double meanDistance() const;

 private:
  std::vector<Pose2> wanted_;
  std::vector<double> distance_;
};

/// Share of the poses within `radius_m` of a start, at any heading, that a chain of at most
/// `pushes` displacements reaches within the tolerance. Deterministic: 2000 poses of a
/// low-discrepancy set.
/// @pre 1 <= pushes <= 3.
double reachableShare(const std::vector<Pose2>& displacements, int pushes, double radius_m,
                      const GoalTolerance& tolerance = {});

}  // namespace casepush
