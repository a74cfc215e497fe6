#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/geometry.h"
#include "casepush/world/cell_box.h"
#include "casepush/world/map.h"

namespace casepush {

/// A solid made ready for collision tests: which (cell, heights) it covers at each heading.
class Footprint;

/// A solid that stands somewhere and is an obstacle.
struct PlacedSolid {
  Solid solid;
  Pose2 map_T_solid;
  std::string name = "";  ///< For explanations, e.g. "chair_1".
};

/// Something that a solid overlaps.
struct Contact {
  enum class With { kMap, kOutside, kObstacle };
  With with = With::kMap;
  int obstacle = -1;  ///< Index into the checker's obstacles.
  /// Horizontal depth of the deepest overlap, with one cell of the map or one part of the obstacle;
  /// or how far the solid reaches out of the map [m].
  double depth_m = 0.0;
  Eigen::Vector2d where_m{0.0, 0.0};  ///< Centre of that cell, or position of the obstacle.
  std::string part;                   ///< Of the obstacle.
};

/// For a person: "the map near (1.20, 3.45)", "chair_1 (seat)", "the outside of the map".
std::string describe(const Contact& contact, const std::vector<PlacedSolid>& obstacles);

/// Tests 3-D solids at planar poses against a map and against other solids.
///
/// A conservative mask test on bit columns decides most queries; what it finds suspicious is
/// decided against the occupied cells themselves. The answer is exact, for the shapes as ConvexPart
/// represents them, grown horizontally by the footprint's margin; against obstacles it is exact
/// where overlapDepth() is, else conservative. Contact without overlap is no collision. Unknown
/// space is free; a solid that reaches out of the map's known extent collides. Thread safety: const
/// methods are reentrant. Copies share the map's columns and are cheap.
class CollisionChecker {
 public:
  /// Cells whose top is not above `floor_m` are the floor and no obstacle.
  /// @throws InputError if the map extends over more than 4096 x 4096 cells.
  explicit CollisionChecker(const Map& map, double floor_m = 0.05);

  /// A rectangle of the map.
  struct Area {
    Eigen::Vector2d min_m{0.0, 0.0};
    Eigen::Vector2d max_m{0.0, 0.0};
  };

  /// The same obstacles on a newer map, of the same resolution, that differs only within an area;
  /// its extent may be another. As if made anew, in a fraction of the time.
  /// @throws InputError as the constructor.
  CollisionChecker updated(const Map& map, const Area& changed) const;

  ~CollisionChecker();
  CollisionChecker(const CollisionChecker&);
  CollisionChecker(CollisionChecker&&) noexcept;
  CollisionChecker& operator=(CollisionChecker&&) noexcept;

  /// Prepares a solid, grown by `margin_m` horizontally. Takes milliseconds: keep it. It can be
  /// used with every checker of a map of the same resolution.
  /// @pre margin_m >= 0 and the solid is not empty.
  std::shared_ptr<const Footprint> footprint(const Solid& solid, double margin_m = 0.0) const;

  /// Replaces the solids that stand around besides the map.
  void setObstacles(std::vector<PlacedSolid> obstacles);
  const std::vector<PlacedSolid>& obstacles() const;

  /// A pose that is not finite collides.
  bool collides(const Footprint& footprint, const Pose2& map_T_solid) const;

  /// Everything that the solid overlaps, with depths: at most one entry for the map, one for each
  /// obstacle and one for the outside, in this order. Empty exactly if it does not collide. @pre
  /// the pose is finite.
  std::vector<Contact> contacts(const Footprint& footprint, const Pose2& map_T_solid) const;

  /// Answer of the mask test alone, for the map without obstacles and outside: false only if free.
  bool maskHits(const Footprint& footprint, const Pose2& map_T_solid) const;

  /// True if the pose lies within the map's horizontal bounds.
  bool isInside(const Pose2& map_T_x) const;

  /// Bit columns: cell (ix, iy) holds one bit for each height slice, set if anything occupied
  /// reaches into the cell and the slice.
  struct Columns {
    Eigen::Vector2d origin_m{0.0, 0.0};  ///< Corner of cell (0, 0).
    double resolution_m = 0.0;
    double slice_m = 0.0;  ///< Height of a bit; bit 0 starts at z = 0 and holds all below; the last
                           ///< bit holds all above.
    int width = 0;
    int height = 0;
    std::vector<std::uint64_t> bits;  ///< Row-major: bits[iy * width + ix].

    /// Cells that reach into an area, as far as there are any.
    CellBox cellsIn(const Area& area) const;
    bool hasSameExtent(const Columns& other) const;
  };
  /// Of map and obstacles.
  const Columns& columns() const;
  /// Of the map alone: the same object for all copies of a checker, so that it can key a cache.
  std::shared_ptr<const Columns> mapColumns() const;

 private:
  friend class SweepChecker;
  struct Data;
  std::unique_ptr<Data> data_;
};

/// True if two placed solids overlap (exact for boxes, cylinders and spheres standing upright; see
/// overlapDepth() for the others).
bool solidsOverlap(const Solid& a, const Pose2& map_T_a, const Solid& b, const Pose2& map_T_b);

}  // namespace casepush
