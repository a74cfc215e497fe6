#include "map_columns.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

#include "casepush/common/input_error.h"
#include "slab.h"

namespace casepush {
namespace {

constexpr int kKeyOfZero = 32768;
constexpr int kMaxCells = 4096;
constexpr double kCoveredHeight_m = 2.0;

/// A run and the column that it is in.
struct PlacedRun {
  std::uint32_t column;
  MapColumns::Run run;
};

}  // namespace

MapColumns::MapColumns(const Map& map, double floor_m) {
  columns.resolution_m = map.resolution();
  const double cells_per_slice = std::ceil(kCoveredHeight_m / (kSlices * map.resolution()));
  columns.slice_m = cells_per_slice * map.resolution();
  if (!map.empty()) setExtent(map);
  columns.bits.assign(static_cast<std::size_t>(columns.width) * columns.height, 0);
  fill(map, floor_m);
}

void MapColumns::setExtent(const Map& map) {
  min_m = map.min().head<2>();
  max_m = map.max().head<2>();
  columns.origin_m = min_m;
  columns.width = static_cast<int>(std::lround((max_m.x() - min_m.x()) / columns.resolution_m));
  columns.height = static_cast<int>(std::lround((max_m.y() - min_m.y()) / columns.resolution_m));
  if (columns.width <= kMaxCells && columns.height <= kMaxCells) return;
  std::ostringstream what;
  what << "extends over " << columns.width << " x " << columns.height << " cells of "
       << columns.resolution_m << " m, at most " << kMaxCells << " x " << kMaxCells
       << " are allowed";
  throw InputError("map", what.str());
}

void MapColumns::fill(const Map& map, double floor_m) {
  const double resolution_m = columns.resolution_m;
  const int lowest = static_cast<int>(std::floor((floor_m + kContactTolerance_m) / resolution_m));
  const int left = static_cast<int>(std::lround(min_m.x() / resolution_m));
  const int bottom = static_cast<int>(std::lround(min_m.y() / resolution_m));
  const octomap::OcTree& tree = map.tree();
  std::vector<PlacedRun> placed;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const int size = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const Run run{std::max(lowest, key[2] - kKeyOfZero), key[2] - kKeyOfZero + size};
    if (run.low >= run.high) continue;
    const int x0 = key[0] - kKeyOfZero - left;
    const int y0 = key[1] - kKeyOfZero - bottom;
    for (int y = y0; y < y0 + size; ++y) {
      for (int x = x0; x < x0 + size; ++x) {
        placed.push_back({static_cast<std::uint32_t>(y * columns.width + x), run});
      }
    }
  }
  std::sort(placed.begin(), placed.end(), [](const PlacedRun& a, const PlacedRun& b) {
    return std::tie(a.column, a.run.low) < std::tie(b.column, b.run.low);
  });
  first_run.assign(columns.bits.size() + 1, 0);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const auto& [column, run] = placed[i];
    const bool continues = i > 0 && placed[i - 1].column == column && runs.back().high == run.low;
    if (continues) {
      runs.back().high = run.high;
    } else {
      runs.push_back(run);
      ++first_run[column + 1];
    }
    columns.bits[column] |=
        sliceMask(run.low * resolution_m, run.high * resolution_m, columns.slice_m);
  }
  for (std::size_t i = 1; i < first_run.size(); ++i) first_run[i] += first_run[i - 1];
}

void visitCells(const PlacedSolid& placed, const CollisionChecker::Columns& columns,
                const std::function<void(std::size_t column, std::uint64_t slices)>& visit) {
  const auto cell = [&](double coordinate_m, double origin_m, int count) {
    const double index = std::floor((coordinate_m - origin_m) / columns.resolution_m);
    return static_cast<int>(std::clamp(index, 0.0, count - 1.0));
  };
  if (columns.width == 0 || columns.height == 0) return;
  for (const ConvexPart& part : convexParts(placed.solid)) {
    for (const Slab& slab : slabs(part, columns.slice_m)) {
      const Shadow shadow = transformed(placed.map_T_solid, slab.shadow);
      Eigen::Vector2d low;
      Eigen::Vector2d high;
      shadowBounds(shadow, &low, &high);
      const int x1 = cell(high.x(), columns.origin_m.x(), columns.width);
      const int y1 = cell(high.y(), columns.origin_m.y(), columns.height);
      for (int y = cell(low.y(), columns.origin_m.y(), columns.height); y <= y1; ++y) {
        for (int x = cell(low.x(), columns.origin_m.x(), columns.width); x <= x1; ++x) {
          const Eigen::Vector2d corner =
              columns.origin_m + Eigen::Vector2d(x, y) * columns.resolution_m;
          const Shadow square = rectangle(corner, corner.array() + columns.resolution_m);
          if (!closerThan(shadow, square, -kContactTolerance_m)) continue;
          visit(static_cast<std::size_t>(y) * columns.width + x, slab.slices);
        }
      }
    }
  }
}

}  // namespace casepush
