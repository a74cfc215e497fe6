#pragma once

#include <vector>

#include "casepush/model/geometry.h"
#include "casepush/world/collision_checker.h"

namespace casepush {

/// A lower bound of the way that an object's origin has to go to a goal region, over the whole map.
///
/// The origin cannot be where the parts right above and below it would overlap something, whatever
/// the heading. So no chain of pushes is shorter, and where the bound is infinite there is none.
class OriginDistance {
 public:
  OriginDistance(const CollisionChecker::Columns& columns, const Solid& object,
                 const Eigen::Vector2d& goal_m, double tolerance_m);

  /// At least so far to the region; infinite if it cannot be reached at all [m].
  double at(const Eigen::Vector2d& point_m) const;

 private:
  Eigen::Vector2d origin_m_;
  double resolution_m_;
  int width_;
  int height_;
  std::vector<float> distance_m_;
};

}  // namespace casepush
