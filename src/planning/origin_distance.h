#pragma once

#include <vector>

#include "casepush/model/geometry.h"
#include "casepush/world/collision_checker.h"
#include "clearance_grid.h"
#include "patience.h"

namespace casepush {

/// The largest discs around an object's origin that its parts contain, at their heights.
std::vector<TravelDisc> innerDiscs(const Solid& object);

/// A lower bound of the way that an object's origin has to go to a goal region, over the whole map.
///
/// The origin cannot be where the parts right above and below it would overlap something, whatever
/// the heading. So no chain of pushes is shorter, and where the bound is infinite there is none.
class OriginDistance {
 public:
  /// @param patience  Once it is over, all that is known is 0.
  OriginDistance(const CollisionChecker::Columns& columns, const Solid& object,
                 const Eigen::Vector2d& goal_m, double tolerance_m,
                 const Patience& patience = Patience());

  /// At least so far to the region; infinite if it cannot be reached at all [m].
  double at(const Eigen::Vector2d& point_m) const;

 private:
  class BlockedCells;

  Eigen::Vector2d origin_m_;
  double resolution_m_;
  int width_;
  int height_;
  int stride_ = 0;  ///< Cells from row to row; around the map lies a rim.
  int first_ = 0;   ///< Index of cell (0, 0).
  std::vector<int> distance_;
};

}  // namespace casepush
