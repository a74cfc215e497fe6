#include "casepush/world/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"
#include "cell_cover.h"
#include "map_stream.h"

namespace casepush {
namespace {

constexpr double kMostCells = 4096.0;  // along each axis of the map
constexpr double kMostPoints = 5e7;
constexpr double kUnturned_rad = 1e-9;

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

/// As if negative and huge values were one: only whether it is in [1, 2^14] counts.
constexpr int kMostGridCells = 1 << 14;

void check(const OccupancyGrid& grid, double resolution_m, const std::string& where) {
  checkResolution(resolution_m, where);
  if (!(grid.resolution_m >= 0.001 && grid.resolution_m <= 10.0)) {
    throw InputError(where,
                     "resolution is " + text(grid.resolution_m) + " m, must be in [0.001, 10] m");
  }
  if (grid.width < 1 || grid.height < 1 || grid.width > kMostGridCells ||
      grid.height > kMostGridCells) {
    throw InputError(where, "has " + std::to_string(grid.width) + " x " +
                                std::to_string(grid.height) + " cells, must have 1 to " +
                                std::to_string(kMostGridCells) + " each way");
  }
  const auto expected = static_cast<std::size_t>(grid.width) * grid.height;
  if (grid.cells.size() != expected) {
    throw InputError(where, "holds " + std::to_string(grid.cells.size()) +
                                " cells, its size says " + std::to_string(expected));
  }
  if (!grid.map_T_grid.isFinite() || grid.map_T_grid.position().norm() > 1e5) {
    throw InputError(where, "its origin is not finite or too far away");
  }
}

class WallBuilder {
 public:
  WallBuilder(const OccupancyGrid& grid, double resolution_m)
      : grid_(grid), resolution_m_(resolution_m) {}

  bool isTurned() const { return std::abs(grid_.map_T_grid.yaw()) > kUnturned_rad; }

  void addWalls(const OccupancyOptions& options) {
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) {
        const int value = grid_.cells[static_cast<std::size_t>(y) * grid_.width + x];
        if (value < 0 ? options.unknown_is_wall : value >= options.occupied_from) addCell(x, y);
      }
    }
    if (!isTurned()) return;
    for (int x = -1; x <= grid_.width; ++x) {
      addCell(x, -1);
      addCell(x, grid_.height);
    }
    for (int y = 0; y < grid_.height; ++y) {
      addCell(-1, y);
      addCell(grid_.width, y);
    }
  }

  /// Bounds in the map of the grid, with the wall around it if it is turned.
  std::pair<Eigen::Vector2d, Eigen::Vector2d> bounds() const {
    const double rim_m = isTurned() ? grid_.resolution_m : 0.0;
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d high = -low;
    for (const double x : {-rim_m, grid_.width * grid_.resolution_m + rim_m}) {
      for (const double y : {-rim_m, grid_.height * grid_.resolution_m + rim_m}) {
        const Eigen::Vector2d corner = grid_.map_T_grid * Eigen::Vector2d(x, y);
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    return {low, high};
  }

  const std::set<std::pair<int, int>>& columns() const { return columns_; }

 private:
  void addCell(int x, int y) {
    const Eigen::Vector2d low = Eigen::Vector2d(x, y) * grid_.resolution_m;
    const double skin_m = std::min(kSkin_m, grid_.resolution_m / 4.0);
    const Shadow square =
        rectangle(low.array() + skin_m, low.array() + grid_.resolution_m - skin_m);
    visitCoveredCells(transformed(grid_.map_T_grid, square), resolution_m_,
                      [this](int ix, int iy) { columns_.emplace(ix, iy); });
  }

  const OccupancyGrid& grid_;
  double resolution_m_;
  std::set<std::pair<int, int>> columns_;
};

}  // namespace

void OccupancyOptions::validate() const {
  Violations violations;
  violations.requirePositive("height_m", height_m, 20.0);
  violations.require("occupied_from", occupied_from, 1, 100);
  violations.throwIfAny("occupancy options");
}

Map mapOf(const OccupancyGrid& grid, const OccupancyOptions& options, double resolution_m,
          const std::string& where) {
  options.validate();
  check(grid, resolution_m, where);
  WallBuilder walls(grid, resolution_m);
  const auto [low, high] = walls.bounds();
  if (!((high - low).maxCoeff() <= kMostCells * resolution_m)) {
    throw InputError(where, "spans " + text((high - low).maxCoeff()) +
                                " m, more than 4096 cells of the map; use a coarser map");
  }
  walls.addWalls(options);
  const int layers = static_cast<int>(std::ceil(options.height_m / resolution_m - 1e-9));
  if (static_cast<double>(walls.columns().size()) * layers > kMostPoints) {
    throw InputError(where, "its walls fill more than 50 million cells; use a coarser map");
  }
  std::vector<Eigen::Vector3f> points;
  addFloorRim(low, high, resolution_m, &points);
  for (const auto& [ix, iy] : walls.columns()) {
    for (int layer = 0; layer < layers; ++layer) {
      points.push_back(cellCentre(ix, iy, layer, resolution_m));
    }
  }
  Map map(resolution_m);
  map.addSurvey(points);
  return map;
}

}  // namespace casepush
