#include "origin_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "casepush/world/shadow.h"
#include "grid_flood.h"

namespace casepush {
namespace {

/// A way along a grid's eight directions is at most 1 / cos(pi / 8) times as long as a straight
/// one.
const double kGridStretch = std::cos(M_PI / 8.0);
// Whole numbers for the two lengths of a step; their ratio is just below the square root of 2, so
// that distances are not too long, by less than 0.04 %.
constexpr int kStraight = 29;
constexpr int kDiagonal = 41;

}  // namespace

std::vector<TravelDisc> innerDiscs(const Solid& object) {
  std::vector<TravelDisc> discs;
  for (const ConvexPart& part : convexParts(object)) {
    const double inside_m = -separation(part.shadow(), Eigen::Vector2d::Zero());
    if (!part.isPrism() || inside_m <= 0.0) continue;
    TravelDisc disc;
    disc.low_m = part.heights().low_m;
    disc.high_m = part.heights().high_m;
    disc.radius_m = inside_m;
    discs.push_back(disc);
  }
  return discs;
}

/// Cells where the object's origin cannot be, with a rim of blocked ones around the map.
class OriginDistance::BlockedCells {
 public:
  BlockedCells(const CollisionChecker::Columns& columns, const std::vector<TravelDisc>& discs,
               const Patience& patience)
      : columns_(columns),
        stride_(columns.width + 2 * kRim),
        blocked_(static_cast<std::size_t>(stride_) * (columns.height + 2 * kRim), 1) {
    // A disc that leaves the map, or reaches into an occupied cell, wherever in its own the origin
    // lies.
    double widest = 0.0;
    for (const TravelDisc& disc : discs) widest = std::max(widest, radiusInCells(disc));
    const int margin = static_cast<int>(std::ceil(std::max(0.0, widest - 0.5)));
    for (int y = margin; y < columns.height - margin; ++y) {
      std::fill_n(blocked_.begin() + index(margin, y), std::max(0, columns.width - 2 * margin), 0);
    }
    for (const TravelDisc& disc : discs) {
      add(slicesOf(disc, columns.slice_m), radiusInCells(disc), patience);
    }
  }

  int stride() const { return stride_; }
  int index(int x, int y) const { return (y + kRim) * stride_ + x + kRim; }
  bool operator[](int cell) const { return blocked_[cell] != 0; }
  std::size_t size() const { return blocked_.size(); }

 private:
  static constexpr int kRim = 1;

  double radiusInCells(const TravelDisc& disc) const {
    return disc.radius_m / columns_.resolution_m - M_SQRT1_2;
  }

  void add(std::uint64_t slices, double radius, const Patience& patience) {
    if (radius <= 0.0) return;
    std::vector<int> half_widths;  // Of the rows 0, 1, ... above and below an occupied cell.
    for (double up = 0.0; up < radius; up = static_cast<double>(half_widths.size()) - 0.5) {
      half_widths.push_back(
          static_cast<int>(std::ceil(0.5 + std::sqrt(radius * radius - up * up))) - 1);
    }
    const auto occupied = [&](int x, int y) {
      return (columns_.bits[static_cast<std::size_t>(y) * columns_.width + x] & slices) != 0;
    };
    for (int y = 0; y < columns_.height && !patience.isOverAfter(columns_.width); ++y) {
      for (int x = 0; x < columns_.width; ++x) {
        if (!occupied(x, y)) continue;
        const bool is_inner = x > 0 && y > 0 && x + 1 < columns_.width && y + 1 < columns_.height &&
                              occupied(x - 1, y) && occupied(x + 1, y) && occupied(x, y - 1) &&
                              occupied(x, y + 1);
        // What such a cell reaches, its neighbours reach as well.
        if (is_inner) {
          blocked_[index(x, y)] = 1;
        } else {
          addAround(x, y, half_widths);
        }
      }
    }
  }

  void addAround(int x, int y, const std::vector<int>& half_widths) {
    const int rows = static_cast<int>(half_widths.size());
    const int last_row = std::min(columns_.height - 1, y + rows - 1);
    for (int row = std::max(0, y - rows + 1); row <= last_row; ++row) {
      const int half = half_widths[std::abs(row - y)];
      const int first = std::max(0, x - half);
      const int last = std::min(columns_.width - 1, x + half);
      std::fill_n(blocked_.begin() + index(first, row), last - first + 1, 1);
    }
  }

  const CollisionChecker::Columns& columns_;
  int stride_;
  std::vector<std::uint8_t> blocked_;
};

OriginDistance::OriginDistance(const CollisionChecker::Columns& columns, const Solid& object,
                               const Eigen::Vector2d& goal_m, double tolerance_m,
                               const Patience& patience)
    : origin_m_(columns.origin_m),
      resolution_m_(columns.resolution_m),
      width_(columns.width),
      height_(columns.height) {
  const BlockedCells blocked(columns, innerDiscs(object), patience);
  stride_ = blocked.stride();
  first_ = blocked.index(0, 0);
  GridFlood flood(static_cast<int>(blocked.size()), stride_, kDiagonal);
  const double reach_m = tolerance_m + resolution_m_ * M_SQRT1_2;
  for (int y = 0; y < height_ && !patience.isOverAfter(width_); ++y) {
    for (int x = 0; x < width_; ++x) {
      const Eigen::Vector2d centre = origin_m_ + resolution_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
      if ((centre - goal_m).squaredNorm() > reach_m * reach_m) continue;
      const int cell = blocked.index(x, y);
      if (!blocked[cell]) flood.begin(cell);
    }
  }
  constexpr std::size_t kSteps = 4;  // Of a cell with its neighbours.
  flood.spread(
      [&blocked](int, int to, bool is_diagonal) {
        return blocked[to] ? 0 : is_diagonal ? kDiagonal : kStraight;
      },
      [&](int, int) { return !patience.isOverAfter(kSteps); });
  distance_ = flood.takeDistance();
  if (patience.isOver()) std::fill(distance_.begin(), distance_.end(), 0);
}

double OriginDistance::at(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d index = (point_m - origin_m_) / resolution_m_;
  if (!(index.x() >= 0.0 && index.y() >= 0.0 && index.x() < width_ && index.y() < height_)) {
    return 0.0;
  }
  const int steps =
      distance_[first_ + static_cast<int>(index.y()) * stride_ + static_cast<int>(index.x())];
  if (steps == GridFlood::kUnreached) return std::numeric_limits<double>::infinity();
  const double grid_m = resolution_m_ / kStraight * steps;
  // Start and end lie anywhere in their cells.
  return std::max(0.0, kGridStretch * grid_m - 2.0 * resolution_m_);
}

}  // namespace casepush
