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

}  // namespace

MapColumns::MapColumns(const Map& map, double floor) : floor_m(floor) {
  columns.resolution_m = map.resolution();
  const double cells_per_slice = std::ceil(kCoveredHeight_m / (kSlices * map.resolution()));
  columns.slice_m = cells_per_slice * map.resolution();
  if (!map.empty()) setExtent(map);
  fill(map, {0, columns.width - 1, 0, columns.height - 1}, nullptr);
}

MapColumns::MapColumns(const Map& map, const MapColumns& before,
                       const CollisionChecker::Area& changed)
    : floor_m(before.floor_m) {
  columns.resolution_m = before.columns.resolution_m;
  columns.slice_m = before.columns.slice_m;
  if (!map.empty()) setExtent(map);
  fill(map, columns.cellsIn(changed), &before);
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

MapColumns::PlacedRuns MapColumns::occupiedIn(const Map& map, const CellBox& box) const {
  const int lowest =
      static_cast<int>(std::floor((floor_m + kContactTolerance_m) / columns.resolution_m));
  const int left = static_cast<int>(std::lround(min_m.x() / columns.resolution_m));
  const int bottom = static_cast<int>(std::lround(min_m.y() / columns.resolution_m));
  const octomap::OcTree& tree = map.tree();
  PlacedRuns placed;
  if (box.x0 > box.x1 || box.y0 > box.y1) return placed;
  const auto key = [](int cell) { return static_cast<octomap::key_type>(cell + kKeyOfZero); };
  const octomap::OcTreeKey first(key(box.x0 + left), key(box.y0 + bottom), 0);
  const octomap::OcTreeKey last(key(box.x1 + left), key(box.y1 + bottom), 2 * kKeyOfZero - 1);
  const auto end = tree.end_leafs_bbx();
  for (auto leaf = tree.begin_leafs_bbx(first, last); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const octomap::OcTreeKey at = leaf.getIndexKey();
    const int size = 1 << (tree.getTreeDepth() - leaf.getDepth());
    const Run run{std::max(lowest, at[2] - kKeyOfZero), at[2] - kKeyOfZero + size};
    if (run.low >= run.high) continue;
    const int x = at[0] - kKeyOfZero - left;
    const int y = at[1] - kKeyOfZero - bottom;
    for (int row = std::max(y, box.y0); row < std::min(y + size, box.y1 + 1); ++row) {
      for (int cell = std::max(x, box.x0); cell < std::min(x + size, box.x1 + 1); ++cell) {
        placed.push_back({static_cast<std::uint32_t>(row * columns.width + cell), run});
      }
    }
  }
  std::sort(placed.begin(), placed.end(), [](const PlacedRun& a, const PlacedRun& b) {
    return std::tie(a.column, a.run.low) < std::tie(b.column, b.run.low);
  });
  return placed;
}

// Takes what lies in the box from the map, and the rest from before.
void MapColumns::fill(const Map& map, const CellBox& box, const MapColumns* before) {
  columns.bits.assign(static_cast<std::size_t>(columns.width) * columns.height, 0);
  first_run.assign(1, 0);
  first_run.reserve(columns.bits.size() + 1);
  const PlacedRuns placed = occupiedIn(map, box);
  auto next = placed.begin();
  const Eigen::Vector2d origin_m = before != nullptr ? before->columns.origin_m : min_m;
  const Eigen::Vector2d shift = (columns.origin_m - origin_m) / columns.resolution_m;
  const auto shift_x = static_cast<int>(std::lround(shift.x()));
  const auto shift_y = static_cast<int>(std::lround(shift.y()));
  const bool rows_match =
      before != nullptr && shift_x == 0 && columns.width == before->columns.width;
  std::uint32_t column = 0;
  for (int y = 0; y < columns.height; ++y) {
    if (rows_match && (y < box.y0 || y > box.y1)) {
      copyRow(y, *before, y + shift_y);
      column += static_cast<std::uint32_t>(columns.width);
      continue;
    }
    for (int x = 0; x < columns.width; ++x, ++column) {
      if (box.contains(x, y)) {
        const auto first = next;
        while (next != placed.end() && next->column == column) ++next;
        addColumn(column, first, next);
      } else if (before != nullptr) {
        copyColumn(column, *before, x + shift_x, y + shift_y);
      }
      first_run.push_back(static_cast<std::uint32_t>(runs.size()));
    }
  }
}

void MapColumns::addColumn(std::uint32_t column, PlacedRuns::const_iterator first,
                           PlacedRuns::const_iterator end) {
  const double resolution_m = columns.resolution_m;
  for (auto placed = first; placed != end; ++placed) {
    const Run& run = placed->run;
    if (placed != first && runs.back().high == run.low) {
      runs.back().high = run.high;
    } else {
      runs.push_back(run);
    }
    columns.bits[column] |=
        sliceMask(run.low * resolution_m, run.high * resolution_m, columns.slice_m);
  }
}

void MapColumns::copyColumn(std::uint32_t column, const MapColumns& from, int x, int y) {
  if (x < 0 || y < 0 || x >= from.columns.width || y >= from.columns.height) return;
  const std::size_t old = static_cast<std::size_t>(y) * from.columns.width + x;
  columns.bits[column] = from.columns.bits[old];
  runs.insert(runs.end(), from.runs.begin() + from.first_run[old],
              from.runs.begin() + from.first_run[old + 1]);
}

void MapColumns::copyRow(int row, const MapColumns& from, int old_row) {
  const auto last = static_cast<std::uint32_t>(runs.size());
  const int width = columns.width;
  if (old_row < 0 || old_row >= from.columns.height) {
    first_run.insert(first_run.end(), width, last);
    return;
  }
  const std::ptrdiff_t old = static_cast<std::ptrdiff_t>(old_row) * width;
  std::copy_n(from.columns.bits.begin() + old, width,
              columns.bits.begin() + static_cast<std::ptrdiff_t>(row) * width);
  const std::uint32_t begin = from.first_run[old];
  runs.insert(runs.end(), from.runs.begin() + begin,
              from.runs.begin() + from.first_run[old + width]);
  for (int x = 1; x <= width; ++x) first_run.push_back(from.first_run[old + x] - begin + last);
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
