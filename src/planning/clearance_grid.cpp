#include "clearance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/world/shadow.h"
#include "distance_transform.h"

namespace casepush {
namespace {

constexpr int kSlices = 64;

/// Largest distance of the shadow from the frame's origin.
double reach(const Shadow& shadow) {
  double result = 0.0;
  for (int i = 0; i < shadow.count; ++i) result = std::max(result, shadow.points[i].norm());
  return result + shadow.radius_m;
}

double widestOf(const std::vector<TravelDisc>& discs) {
  double widest_m = 0.0;
  for (const TravelDisc& disc : discs) widest_m = std::max(widest_m, disc.radius_m);
  return widest_m;
}

/// What lies farther away than this does not matter.
int rangeInCells(const CollisionChecker::Columns& columns, const std::vector<TravelDisc>& discs) {
  return static_cast<int>(
             std::ceil((ClearanceGrid::kMost_m + widestOf(discs)) / columns.resolution_m)) +
         1;
}

/// 1 where something of a box's cells is occupied in the slices, row by row.
std::vector<std::uint8_t> occupiedIn(const CollisionChecker::Columns& columns, const CellBox& box,
                                     std::uint64_t slices) {
  std::vector<std::uint8_t> occupied;
  occupied.reserve(static_cast<std::size_t>(box.width()) * box.height());
  for (int y = box.y0; y <= box.y1; ++y) {
    const std::uint64_t* row = columns.bits.data() + static_cast<std::ptrdiff_t>(y) * columns.width;
    for (int x = box.x0; x <= box.x1; ++x) occupied.push_back((row[x] & slices) != 0);
  }
  return occupied;
}

}  // namespace

std::uint64_t slicesOf(const TravelDisc& disc, double slice_m) {
  const auto index = [&](double z_m) {
    return static_cast<int>(std::clamp(std::floor(z_m / slice_m), 0.0, kSlices - 1.0));
  };
  const int first = index(disc.low_m + kContactTolerance_m);
  const int last = std::max(first, index(disc.high_m - kContactTolerance_m));
  return (~std::uint64_t{0} << first) & (~std::uint64_t{0} >> (kSlices - 1 - last));
}

std::vector<TravelDisc> travelDiscs(const Solid& solid, double margin_m) {
  const std::vector<ConvexPart> parts = convexParts(solid);
  std::vector<double> ends;
  for (const ConvexPart& part : parts) {
    ends.push_back(part.heights().low_m);
    ends.push_back(part.heights().high_m);
  }
  std::sort(ends.begin(), ends.end());
  std::vector<TravelDisc> discs;
  for (std::size_t i = 1; i < ends.size(); ++i) {
    double radius_m = 0.0;
    for (const ConvexPart& part : parts) {
      const Shadow shadow = part.shadow(ends[i - 1], ends[i]);
      if (!shadow.empty()) radius_m = std::max(radius_m, reach(shadow) + margin_m);
    }
    if (radius_m <= 0.0) continue;
    const bool continues =
        !discs.empty() && discs.back().high_m == ends[i - 1] && discs.back().radius_m == radius_m;
    if (continues) {
      discs.back().high_m = ends[i];
    } else {
      discs.push_back({ends[i - 1], ends[i], radius_m});
    }
  }
  return discs;
}

ClearanceGrid::ClearanceGrid(const CollisionChecker::Columns& columns,
                             const std::vector<TravelDisc>& discs, const Patience& patience)
    : ClearanceGrid(columns, discs, {0, columns.width - 1, 0, columns.height - 1}, patience) {}

ClearanceGrid::ClearanceGrid(const CollisionChecker::Columns& columns,
                             const std::vector<TravelDisc>& discs, const CellBox& box,
                             const Patience& patience)
    : origin_m_(columns.origin_m + columns.resolution_m * Eigen::Vector2d(box.x0, box.y0)),
      resolution_m_(columns.resolution_m),
      width_(box.width()),
      height_(box.height()),
      clearance_m_(static_cast<std::size_t>(width_) * height_) {
  const double widest_m = widestOf(discs);
  for (int cell = 0; cell < size() && !patience.isOverAfter(1); ++cell) {
    const int x = box.x0 + cell % width_;
    const int y = box.y0 + cell / width_;
    const int border = std::min({x, y, columns.width - 1 - x, columns.height - 1 - y});
    const double clearance = (border + 0.5) * resolution_m_ - widest_m;
    clearance_m_[cell] = static_cast<float>(std::min(clearance, kMost_m));
  }
  const CellBox seen = box.grown(rangeInCells(columns, discs), {columns.width, columns.height});
  for (const TravelDisc& disc : discs) {
    const std::vector<std::uint8_t> occupied =
        occupiedIn(columns, seen, slicesOf(disc, columns.slice_m));
    const std::vector<float> distance =
        distanceToSquares(occupied, seen.width(), seen.height(), patience);
    const float* first = distance.data() +
                         static_cast<std::ptrdiff_t>(box.y0 - seen.y0) * seen.width() + box.x0 -
                         seen.x0;
    for (int cell = 0; cell < size() && !patience.isOverAfter(1); ++cell) {
      const float cells =
          first[static_cast<std::ptrdiff_t>(cell / width_) * seen.width() + cell % width_];
      const double clearance = cells * resolution_m_ - disc.radius_m;
      clearance_m_[cell] = std::min(clearance_m_[cell], static_cast<float>(clearance));
    }
  }
}

CellBox ClearanceGrid::affected(const CollisionChecker::Columns& columns,
                                const std::vector<TravelDisc>& discs,
                                const CollisionChecker::Area& changed) {
  const CellBox box = columns.cellsIn(changed);
  if (box.empty()) return {};
  return box.grown(rangeInCells(columns, discs), {columns.width, columns.height});
}

ClearanceGrid ClearanceGrid::updated(const CollisionChecker::Columns& columns,
                                     const std::vector<TravelDisc>& discs,
                                     const CollisionChecker::Area& changed) const {
  ClearanceGrid result(*this);
  const CellBox box = affected(columns, discs, changed);
  if (box.empty()) return result;
  const ClearanceGrid part(columns, discs, box);
  for (int y = 0; y < part.height(); ++y) {
    const auto row = part.clearance_m_.begin() + static_cast<std::ptrdiff_t>(y) * part.width();
    std::copy_n(
        row, part.width(),
        result.clearance_m_.begin() + static_cast<std::ptrdiff_t>(box.y0 + y) * width_ + box.x0);
  }
  return result;
}

void ClearanceGrid::add(const PlacedSolid& placed, const std::vector<TravelDisc>& discs,
                        double range_m) {
  for (const ConvexPart& part : convexParts(placed.solid)) {
    for (const TravelDisc& disc : discs) {
      const Shadow own = part.shadow(disc.low_m, disc.high_m);
      if (own.empty()) continue;
      const Shadow shadow = transformed(placed.map_T_solid, own);
      Eigen::Array2d low = shadow.points[0];
      Eigen::Array2d high = low;
      for (int i = 1; i < shadow.count; ++i) {
        low = low.min(shadow.points[i].array());
        high = high.max(shadow.points[i].array());
      }
      const double grown_m = shadow.radius_m + disc.radius_m + range_m;
      low = ((low - grown_m - origin_m_.array()) / resolution_m_).max(0.0);
      high = (high + grown_m - origin_m_.array()) / resolution_m_;
      const int x1 = static_cast<int>(std::min(high.x(), width_ - 1.0));
      const int y1 = static_cast<int>(std::min(high.y(), height_ - 1.0));
      if (high.x() < 0.0 || high.y() < 0.0) continue;
      const BoundingDisc around = boundingDisc(shadow);
      const double discs_m = around.radius_m + disc.radius_m;
      for (int y = static_cast<int>(low.y()); y <= y1; ++y) {
        for (int x = static_cast<int>(low.x()); x <= x1; ++x) {
          float& own_m = clearance_m_[y * width_ + x];
          const Eigen::Vector2d point = centre(x, y);
          const double enough_m = std::max(0.0, own_m + discs_m);
          if ((point - around.centre_m).squaredNorm() >= enough_m * enough_m) continue;
          own_m = std::min(own_m, static_cast<float>(separation(shadow, point) - disc.radius_m));
        }
      }
    }
  }
}

float ClearanceGrid::clearanceAlong(const Eigen::Vector2d& from_m,
                                    const Eigen::Vector2d& to_m) const {
  // Walks from border to border of the cells (Amanatides and Woo, 1987). Where the line passes a
  // corner exactly, it goes on in the opposite cell: a diagonal step touches only two cells.
  constexpr double kSameInstant = 1e-9;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const int end = cell(to_m);
  int current = cell(from_m);
  if (end < 0 || current < 0) return -std::numeric_limits<float>::infinity();
  const Eigen::Vector2d start = (from_m - origin_m_) / resolution_m_;
  const Eigen::Vector2d along = (to_m - from_m) / resolution_m_;
  int step[2];
  double next[2];
  double period[2];
  for (int axis = 0; axis < 2; ++axis) {
    step[axis] = along[axis] > 0.0 ? 1 : -1;
    period[axis] = along[axis] == 0.0 ? kInfinity : std::abs(1.0 / along[axis]);
    const double within = start[axis] - std::floor(start[axis]);
    const double ahead = along[axis] > 0.0 ? 1.0 - within : within;
    next[axis] = along[axis] == 0.0 ? kInfinity : ahead * period[axis];
  }
  float least = std::min(clearance_m_[current], clearance_m_[end]);
  while (current != end && std::min(next[0], next[1]) <= 1.0) {
    const double earliest = std::min(next[0], next[1]);
    for (int axis = 0; axis < 2; ++axis) {
      if (next[axis] > earliest + kSameInstant) continue;
      current += axis == 0 ? step[0] : step[1] * width_;
      next[axis] += period[axis];
    }
    // A line that ends on the grid's border may seem to cross it, by rounding.
    if (current < 0 || current >= size()) break;
    least = std::min(least, clearance_m_[current]);
  }
  return least;
}

}  // namespace casepush
