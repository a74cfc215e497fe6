#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "casepush/world/collision_checker.h"
#include "patience.h"

namespace casepush {

/// The robot at some heights, whichever way it faces: a disc about its origin.
struct TravelDisc {
  double low_m;
  double high_m;
  double radius_m;
};

/// Bits of the height slices that a disc reaches into.
std::uint64_t slicesOf(const TravelDisc& disc, double slice_m);

/// A disc for each height interval between the ends of the solid's parts, grown by `margin_m`.
std::vector<TravelDisc> travelDiscs(const Solid& solid, double margin_m);

/// For each cell's centre, how far the stack of discs is from touching anything, up to kMost_m.
class ClearanceGrid {
 public:
  static constexpr double kMost_m = 1.0;  ///< More is not told apart.

  /// Free distance in the map alone: exact between a cell's centre and the occupied cells' squares
  /// in the height slices that a disc reaches into, and the map's border.
  /// @param patience  Once it is over, the grid is unfinished.
  ClearanceGrid(const CollisionChecker::Columns& columns, const std::vector<TravelDisc>& discs,
                const Patience& patience = Patience());

  /// Some cells of the grid of the whole map; `box` lies within it.
  ClearanceGrid(const CollisionChecker::Columns& columns, const std::vector<TravelDisc>& discs,
                const CellBox& box, const Patience& patience = Patience());

  /// For columns of the same extent that differ only within an area: as if made anew.
  ClearanceGrid updated(const CollisionChecker::Columns& columns,
                        const std::vector<TravelDisc>& discs,
                        const CollisionChecker::Area& changed) const;

  /// Cells whose clearance may change with what lies in an area.
  static CellBox affected(const CollisionChecker::Columns& columns,
                          const std::vector<TravelDisc>& discs,
                          const CollisionChecker::Area& changed);

  /// Lowers the clearance around a solid, exactly up to `range_m`, above which it does not matter.
  void add(const PlacedSolid& placed, const std::vector<TravelDisc>& discs, double range_m);

  int width() const { return width_; }
  int height() const { return height_; }
  int size() const { return width_ * height_; }
  const Eigen::Vector2d& origin() const { return origin_m_; }  ///< Corner of cell 0.
  double resolution() const { return resolution_m_; }
  float clearance(int cell) const { return clearance_m_[cell]; }

  /// Index of the cell that holds the point; -1 outside.
  int cell(const Eigen::Vector2d& point_m) const { return locate(point_m).cell; }
  Eigen::Vector2d centre(int cell) const { return centre(cell % width_, cell / width_); }
  Eigen::Vector2d centre(int x, int y) const {
    return origin_m_ + resolution_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
  }

  /// A cell and its centre.
  struct Place {
    int cell;  ///< -1 outside.
    Eigen::Vector2d centre_m;
  };
  Place locate(const Eigen::Vector2d& point_m) const {
    const Eigen::Vector2d at = (point_m - origin_m_) / resolution_m_;
    if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < width_ && at.y() < height_)) {
      return {-1, {0.0, 0.0}};
    }
    const int x = static_cast<int>(at.x());
    const int y = static_cast<int>(at.y());
    return {y * width_ + x, centre(x, y)};
  }

  /// Smallest clearance of the cells that the straight line passes; -infinity if it leaves the
  /// grid.
  float clearanceAlong(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) const;

 private:
  Eigen::Vector2d origin_m_;
  double resolution_m_;
  int width_;
  int height_;
  std::vector<float> clearance_m_;
};

}  // namespace casepush
