#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/geometry.h"
#include "casepush/world/map.h"

namespace casepush {

/// A solid made ready for collision tests: which (cell, heights) it covers at each heading.
class Footprint;

/// A solid that stands somewhere and is an obstacle.
struct PlacedSolid {
  Solid solid;
  Pose2 map_T_solid;
};

/// Tests 3-D solids at planar poses against a map and against other solids.
///
/// A conservative mask test on bit columns decides most queries; what it finds suspicious is decided
/// exactly against the occupied cells and solids. No false negatives (against the occupied cells).
/// Unknown space is free; outside of the map's bounds is a collision.
/// Thread safety: const methods are reentrant.
class CollisionChecker {
 public:
  /// Cells whose top is not above `floor_m` are the floor and no obstacle.
  explicit CollisionChecker(const Map& map, double floor_m = 0.05);
  ~CollisionChecker();
  CollisionChecker(const CollisionChecker&);
  CollisionChecker(CollisionChecker&&) noexcept;

  /// Prepares a solid, grown by `margin_m` horizontally.
  std::shared_ptr<const Footprint> footprint(const Solid& solid, double margin_m = 0.0) const;

  /// Replaces the solids that stand around besides the map.
  void setObstacles(std::vector<PlacedSolid> obstacles);

  bool collides(const Footprint& footprint, const Pose2& map_T_solid) const;

  /// True if the pose lies within the map's horizontal bounds.
  bool isInside(const Pose2& map_T_x) const;

  /// Bit columns of map and obstacles, for robot path planning: cell (ix, iy) holds one bit for each
  /// height slice.
  struct Columns {
    Eigen::Vector2d origin_m;  ///< Corner of cell (0, 0).
    double resolution_m;
    double slice_m;  ///< Height of one bit; bit 0 starts at z = 0; the last bit holds all above.
    int width;
    int height;
    std::vector<std::uint64_t> bits;  ///< Row-major: bits[iy * width + ix].
  };
  const Columns& columns() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// True if two placed solids overlap (exact for boxes, cylinders and spheres standing upright).
bool solidsOverlap(const Solid& a, const Pose2& map_T_a, const Solid& b, const Pose2& map_T_b);

}  // namespace casepush
