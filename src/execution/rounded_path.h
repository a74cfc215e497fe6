#pragma once

#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

/// Straight segments between waypoints, their corners replaced by arcs of a circle.
struct RoundedPath {
  std::vector<Pose2> waypoints;  ///< Ends as given; arcs are chains of short segments.
  /// Radius of the arc that each waypoint lies on [m]; 0: a corner that is left as it is, infinite:
  /// no corner.
  std::vector<double> radius_m;
};

/// What the robot can do at a corner.
struct CornerLimits {
  double cut_m;              ///< How far from the corner an arc may pass.
  double end_cut_m;          ///< The same at the first and the last corner.
  double step_mps;           ///< Change of velocity at a corner that is left as it is.
  double acceleration_mps2;  ///< Towards the centre of an arc.
};

/// Rounds corners off where the robot is faster along an arc. Each begins and ends at most half a
/// segment from its corner; headings change as along the segments.
RoundedPath roundCorners(const std::vector<Pose2>& waypoints, const CornerLimits& limits);

}  // namespace casepush
