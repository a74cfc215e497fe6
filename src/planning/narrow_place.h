#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "casepush/model/geometry.h"
#include "casepush/world/collision_checker.h"
#include "patience.h"

namespace casepush {

/// A place that is too narrow for an object.
struct NarrowPlace {
  Eigen::Vector2d where_m;
  double width_m;   ///< Between what is occupied, to about a cell.
  double needed_m;  ///< Width of the object at the same heights, however it is turned.
};

/// Where some points lie in a gap that is narrower than the object: of all heights of the object
/// and all points what it lacks most. Nothing if there is no such gap, of those looked at until
/// `patience` is over.
std::optional<NarrowPlace> narrowestPlace(const CollisionChecker::Columns& columns,
                                          const Solid& object,
                                          const std::vector<Eigen::Vector2d>& points_m,
                                          const Patience& patience = Patience());

}  // namespace casepush
