#pragma once

#include "casepush/world/collision_checker.h"
#include "footprint.h"
#include "map_columns.h"

namespace casepush {

/// Lowest corner of a column's cell in the map.
inline Eigen::Vector2d columnCorner(const CollisionChecker::Columns& columns, std::size_t column) {
  const Eigen::Vector2d cell(static_cast<double>(column % columns.width),
                             static_cast<double>(column / columns.width));
  return columns.origin_m + columns.resolution_m * cell;
}

/// How deep a grown solid reaches into the occupied cells of a column, whose square is given in the
/// solid's frame; 0 if not.
double depthInColumn(const Footprint& footprint, const Shadow& square, const MapColumns& map,
                     std::size_t column);

/// `depthInColumn(...) > 0.0` for one part of the footprint, faster.
bool partReachesInto(const Footprint& footprint, std::size_t part, const Shadow& square,
                     const MapColumns& map, std::size_t column);

/// A footprint at a pose. Cells are compared in the solid's own frame, where its shadows are ready.
class PlacedFootprint {
 public:
  PlacedFootprint(const Footprint& footprint, const Pose2& map_T_solid)
      : footprint_(footprint), map_T_solid_(map_T_solid), solid_T_map_(map_T_solid.inverse()) {}

  /// How deep the grown solid reaches into the occupied cells of a column of the map; 0 if not.
  double depthIn(const MapColumns& map, std::size_t column) const;

  /// How far the grown solid reaches out of the rectangle; 0 if not.
  double depthOutside(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m) const;

 private:
  const Footprint& footprint_;
  Pose2 map_T_solid_;
  Pose2 solid_T_map_;
};

}  // namespace casepush
