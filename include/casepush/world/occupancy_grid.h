#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/world/map.h"

namespace casepush {

/// A floor plan as 2-D navigation has it (nav_msgs/OccupancyGrid).
struct OccupancyGrid {
  int width = 0;  ///< Cells along the grid's x axis.
  int height = 0;
  double resolution_m = 0.0;
  Pose2 map_T_grid;  ///< The grid's origin is the outer corner of cell (0, 0).
  /// Row by row from y = 0: 0 (free) to 100 (occupied), -1: unknown.
  std::vector<std::int8_t> cells;
};

struct OccupancyOptions {
  double height_m = 1.5;         ///< Walls reach from the floor up to there.
  int occupied_from = 65;        ///< Cells of this value or more are walls.
  bool unknown_is_wall = false;  ///< Else it is free.
  void validate() const;         ///< @throws InputError listing every violation.
};

/// Reads a map_server file: YAML with `image` (.pgm, ASCII or binary), `resolution`, `origin`
/// and, optionally, `negate`, `occupied_thresh`, `free_thresh`, `mode` (trinary, scale, raw).
/// @throws InputError naming the file and what is wrong with it.
OccupancyGrid loadOccupancyGrid(const std::filesystem::path& yaml_file);

/// Walls of the given height where the grid is occupied. All of the grid counts as known; around a
/// turned grid, whose bounds the map's cannot follow, stands a wall.
/// @param where  Names the grid in messages.
/// @throws InputError if sizes or numbers make no sense, or the map would be too large.
Map mapOf(const OccupancyGrid& grid, const OccupancyOptions& options, double resolution_m,
          const std::string& where);

}  // namespace casepush
