#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "casepush/world/map.h"
#include "casepush/world/occupancy_grid.h"

namespace casepush {

struct MapFileOptions {
  /// Of the map that is made; nothing: that of an OctoMap file itself, and 0.05 m for the others.
  std::optional<double> resolution_m;
  OccupancyOptions occupancy;  ///< For floor plans.
  double low_m = 0.05;         ///< Points of a cloud below are the floor,
  double high_m = 2.0;         ///< and points above the ceiling.
};

/// Reads whatever is a map: OctoMap (.bt, .ot), floor plan of map_server (.yaml), point cloud
/// (.pcd, .xyz).
/// @throws InputError naming the file and what is wrong with it.
Map loadMap(const std::filesystem::path& file, const MapFileOptions& options = {});

/// The same space in cells of another size: whatever an occupied cell reaches into is occupied, and
/// what was known keeps its extent. @throws InputError for a bad resolution or too many cells.
Map resampled(const Map& map, double resolution_m);

struct MapSize {
  std::size_t nodes = 0;
  std::size_t leaves = 0;
  std::size_t occupied_leaves = 0;
  double occupied_m3 = 0.0;
  double free_m3 = 0.0;  ///< Known to be free.
  std::size_t memory_bytes = 0;
};
MapSize sizeOf(const Map& map);

}  // namespace casepush
