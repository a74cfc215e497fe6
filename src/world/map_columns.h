#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "casepush/world/collision_checker.h"
#include "casepush/world/map.h"

namespace casepush {

/// A map's obstacles by column: bits for the mask test, and the occupied cells themselves as
/// vertical runs for the exact one.
struct MapColumns {
  MapColumns(const Map& map, double floor_m);

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

 private:
  void setExtent(const Map& map);
  void fill(const Map& map, double floor_m);
};

/// Visits every cell of the columns that a placed solid reaches into, with the slices it covers
/// there; a cell may come up several times.
void visitCells(const PlacedSolid& placed, const CollisionChecker::Columns& columns,
                const std::function<void(std::size_t column, std::uint64_t slices)>& visit);

}  // namespace casepush
