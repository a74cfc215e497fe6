#pragma once

#include <vector>

#include "casepush/model/geometry.h"
#include "casepush/world/shadow.h"

namespace casepush {

/// Convex hull of a solid seen from above, in its frame; round parts by a polygon around them.
Shadow outlineOf(const Solid& solid);

/// What bodies will pass over, seen from above: their outlines at the poses on their way.
class Way {
 public:
  /// @param outline  In the frame of the body at `map_T_body`.
  void add(const Shadow& outline, const Pose2& map_T_body);

  bool empty() const { return stations_.empty(); }

  /// Distance of an outline there from the nearest station, `limit_m` if nothing is nearer;
  /// negative where they overlap [m].
  double distance(const Shadow& outline, const Pose2& map_T_body, double limit_m) const;

 private:
  struct Station {
    Shadow map_outline;
    BoundingDisc disc;
  };
  std::vector<Station> stations_;
};

}  // namespace casepush
