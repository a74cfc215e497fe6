#include "drive_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grid_flood.h"

namespace casepush {
namespace {

// Lengths of a step, in whole numbers.
constexpr int kStraight = 12;
constexpr int kDiagonal = 17;
// A docked robot stands this far from where it can travel, at most; of the cells there those count
// that are hardly farther off than the nearest one: others may lie behind the object.
constexpr double kDocked_m = 0.5;
constexpr double kAsNear_m = 0.1;

}  // namespace

DriveField::DriveField(ClearanceGrid grid, double min_clearance_m, const Eigen::Vector2d& place)
    : grid_(std::move(grid)), min_clearance_m_(static_cast<float>(min_clearance_m)) {
  GridFlood flood(grid_.size(), grid_.width(), kDiagonal);
  for (const End& end : endsAt(place)) flood.begin(end.cell);
  flood.spread(
      [this](int, int to, bool is_diagonal) {
        return isFree(to) ? (is_diagonal ? kDiagonal : kStraight) : 0;
      },
      [](int, int) { return true; });
  distance_ = flood.takeDistance();
}

// Ways over the grid's rim would go on at its other side.
bool DriveField::isFree(int cell) const {
  const int x = cell % grid_.width();
  const int y = cell / grid_.width();
  return x > 0 && y > 0 && x + 1 < grid_.width() && y + 1 < grid_.height() &&
         grid_.clearance(cell) >= min_clearance_m_;
}

std::vector<DriveField::End> DriveField::endsAt(const Eigen::Vector2d& place) const {
  std::vector<End> ends;
  const int own = grid_.cell(place);
  if (own < 0) return ends;
  if (isFree(own)) return {{own, 0.0}};
  const int reach = static_cast<int>(kDocked_m / grid_.resolution());
  double nearest_m = kDocked_m;
  for (int y = std::max(0, own / grid_.width() - reach);
       y <= std::min(grid_.height() - 1, own / grid_.width() + reach); ++y) {
    for (int x = std::max(0, own % grid_.width() - reach);
         x <= std::min(grid_.width() - 1, own % grid_.width() + reach); ++x) {
      const int cell = y * grid_.width() + x;
      if (!isFree(cell)) continue;
      const double length_m = (grid_.centre(cell) - place).norm();
      nearest_m = std::min(nearest_m, length_m);
      if (length_m <= nearest_m + kAsNear_m) ends.push_back({cell, length_m});
    }
  }
  ends.erase(std::remove_if(ends.begin(), ends.end(),
                            [&](const End& end) { return end.length_m > nearest_m + kAsNear_m; }),
             ends.end());
  return ends;
}

double DriveField::lengthTo(const Eigen::Vector2d& place) const {
  double shortest_m = std::numeric_limits<double>::infinity();
  for (const End& end : endsAt(place)) {
    const int steps = distance_[end.cell];
    if (steps == GridFlood::kUnreached) continue;
    shortest_m = std::min(shortest_m, steps * grid_.resolution() / kStraight + end.length_m);
  }
  return shortest_m;
}

}  // namespace casepush
