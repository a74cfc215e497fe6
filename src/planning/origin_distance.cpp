#include "origin_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include "casepush/world/shadow.h"
#include "clearance_grid.h"

namespace casepush {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// A way along a grid's eight directions is at most 1 / cos(pi / 8) times as long as a straight
/// one.
const double kGridStretch = std::cos(M_PI / 8.0);

/// The largest discs around the origin that parts contain.
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

}  // namespace

OriginDistance::OriginDistance(const CollisionChecker::Columns& columns, const Solid& object,
                               const Eigen::Vector2d& goal_m, double tolerance_m)
    : origin_m_(columns.origin_m),
      resolution_m_(columns.resolution_m),
      width_(columns.width),
      height_(columns.height),
      distance_m_(columns.bits.size(), kInfinity) {
  const ClearanceGrid grid(columns, innerDiscs(object));
  const double half_diagonal_m = resolution_m_ * M_SQRT1_2;
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto reach = [&](int cell, float distance_m) {
    if (distance_m >= distance_m_[cell] || grid.clearance(cell) < -half_diagonal_m) return;
    distance_m_[cell] = distance_m;
    open.emplace(distance_m, cell);
  };
  for (int cell = 0; cell < grid.size(); ++cell) {
    if ((grid.centre(cell) - goal_m).norm() <= tolerance_m + half_diagonal_m) reach(cell, 0.0F);
  }
  while (!open.empty()) {
    const auto [distance_m, cell] = open.top();
    open.pop();
    if (distance_m > distance_m_[cell]) continue;
    const int x = cell % width_;
    const int y = cell / width_;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const int nx = x + dx;
        const int ny = y + dy;
        if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
        const double step_m = resolution_m_ * (dx != 0 && dy != 0 ? M_SQRT2 : 1.0);
        reach(ny * width_ + nx, distance_m + static_cast<float>(step_m));
      }
    }
  }
}

double OriginDistance::at(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d index = (point_m - origin_m_) / resolution_m_;
  if (!(index.x() >= 0.0 && index.y() >= 0.0 && index.x() < width_ && index.y() < height_)) {
    return 0.0;
  }
  const double grid_m = distance_m_[static_cast<std::size_t>(index.y()) * width_ +
                                    static_cast<std::size_t>(index.x())];
  // Start and end lie anywhere in their cells.
  return std::max(0.0, kGridStretch * grid_m - 2.0 * resolution_m_);
}

}  // namespace casepush
