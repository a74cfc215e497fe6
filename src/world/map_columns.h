#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "casepush/world/cell_box.h"
#include "casepush/world/collision_checker.h"
#include "casepush/world/map.h"

namespace casepush {

/// A map's obstacles by column: bits for the mask test, and the occupied cells themselves as
/// vertical runs for the exact one.
struct MapColumns {
  MapColumns(const Map& map, double floor_m);

  /// Of a map that differs from the one of `before` only within an area: the same as made anew.
  MapColumns(const Map& map, const MapColumns& before, const CollisionChecker::Area& changed);

  /// Cells low, ..., high - 1 above z = 0 are occupied.
  struct Run {
    int low;
    int high;
  };

  CollisionChecker::Columns columns;
  std::vector<std::uint32_t> first_run;  ///< Of each column, in `runs`; one more at the end.
  std::vector<Run> runs;
  Eigen::Vector2d min_m{0.0, 0.0};  ///< Known extent; both equal for an empty map.
  Eigen::Vector2d max_m{0.0, 0.0};
  double floor_m = 0.0;

 private:
  /// A run and the column that it is in.
  struct PlacedRun {
    std::uint32_t column;
    Run run;
  };
  using PlacedRuns = std::vector<PlacedRun>;

  void setExtent(const Map& map);
  PlacedRuns occupiedIn(const Map& map, const CellBox& box) const;
  void fill(const Map& map, const CellBox& box, const MapColumns* before);
  void addColumn(std::uint32_t column, PlacedRuns::const_iterator first,
                 PlacedRuns::const_iterator end);
  void copyRow(int row, const MapColumns& from, int old_row);
  void copyColumn(std::uint32_t column, const MapColumns& from, int x, int y);
};

/// Visits every cell of the columns that a placed solid reaches into, with the slices it covers
/// there; a cell may come up several times.
void visitCells(const PlacedSolid& placed, const CollisionChecker::Columns& columns,
                const std::function<void(std::size_t column, std::uint64_t slices)>& visit);

}  // namespace casepush
