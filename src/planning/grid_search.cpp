#include "grid_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace casepush {
namespace {

/// More clearance than this is not better [m].
constexpr double kPreferredClearance_m = 0.2;
/// A shortcut may come closer than the path did by so much, but not closer than this to anything.
constexpr double kCloser_m = 0.05;
constexpr double kShortcutClearance_m = 0.08;
/// Travelling without any clearance costs as much as this many times the length with enough of it.
constexpr double kTightFactor = 3.0;
/// Of one cell with its neighbours, for Patience.
constexpr std::size_t kSteps = 8;

/// Cell to expand, the best first: lowest estimate of the whole way, then the farthest one on, then
/// the lowest index, so that the order does not depend on the queue's implementation.
struct OpenCell {
  double estimate;
  double cost;
  int cell;

  bool operator<(const OpenCell& other) const {
    return std::tie(other.estimate, cost, other.cell) < std::tie(estimate, other.cost, cell);
  }
};

}  // namespace

template <typename Visit>
void GridSearch::visitNeighbours(int cell, Visit visit) const {
  const int x = cell % grid_.width();
  const int y = cell / grid_.width();
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const bool within =
          x + dx >= 0 && y + dy >= 0 && x + dx < grid_.width() && y + dy < grid_.height();
      if (!within || (dx == 0 && dy == 0)) continue;
      visit(cell + dy * grid_.width() + dx, dx != 0 && dy != 0 ? M_SQRT2 : 1.0);
    }
  }
}

std::vector<std::uint8_t> GridSearch::reachable(int from) const {
  std::vector<std::uint8_t> reached(grid_.size(), 0);
  std::vector<int> open{from};
  reached[from] = 1;
  while (!open.empty() && !patience_.isOverAfter(kSteps)) {
    const int cell = open.back();
    open.pop_back();
    visitNeighbours(cell, [&](int next, double) {
      if (reached[next] || !isFree(next)) return;
      reached[next] = 1;
      open.push_back(next);
    });
  }
  return reached;
}

double GridSearch::costFactor(int cell) const {
  const double clearance = std::clamp<double>(grid_.clearance(cell), 0.0, kPreferredClearance_m);
  return kTightFactor - (kTightFactor - 1.0) * clearance / kPreferredClearance_m;
}

double GridSearch::shortcutClearance(double path_clearance_m) const {
  const double clearance_m = std::min(path_clearance_m, kPreferredClearance_m);
  return std::min(clearance_m, std::max(clearance_m - kCloser_m, kShortcutClearance_m));
}

double GridSearch::octileDistance(int a, int b) const {
  const int dx = std::abs(a % grid_.width() - b % grid_.width());
  const int dy = std::abs(a / grid_.width() - b / grid_.width());
  return std::max(dx, dy) + (M_SQRT2 - 1.0) * std::min(dx, dy);
}

std::vector<int> GridSearch::path(int from, int to) const {
  constexpr int kNone = -1;
  std::vector<double> cost(grid_.size(), std::numeric_limits<double>::infinity());
  std::vector<int> parent(grid_.size(), kNone);
  std::priority_queue<OpenCell> open;
  cost[from] = 0.0;
  open.push({octileDistance(from, to), 0.0, from});
  while (!open.empty() && open.top().cell != to) {
    if (patience_.isOverAfter(kSteps)) return {};
    const OpenCell best = open.top();
    open.pop();
    if (best.cost > cost[best.cell]) continue;
    visitNeighbours(best.cell, [&](int next, double length) {
      if (!isFree(next)) return;
      const double next_cost = best.cost + length * costFactor(next);
      if (next_cost >= cost[next]) return;
      cost[next] = next_cost;
      parent[next] = best.cell;
      open.push({next_cost + octileDistance(next, to), next_cost, next});
    });
  }
  if (open.empty()) return {};
  std::vector<int> cells;
  for (int cell = to; cell != kNone; cell = parent[cell]) cells.push_back(cell);
  std::reverse(cells.begin(), cells.end());
  return cells;
}

std::vector<Eigen::Vector2d> GridSearch::travel(const Eigen::Vector2d& start,
                                                const Eigen::Vector2d& goal) const {
  const std::vector<int> cells = path(grid_.cell(start), grid_.cell(goal));
  if (cells.empty()) return {};
  std::vector<Eigen::Vector2d> points{start};
  for (const int cell : cells) points.push_back(grid_.centre(cell));
  points.push_back(goal);
  return shortcut(points);
}

std::vector<Eigen::Vector2d> GridSearch::shortcut(
    const std::vector<Eigen::Vector2d>& points) const {
  std::vector<Eigen::Vector2d> corners{points.front()};
  std::size_t at = 0;
  while (at + 1 < points.size()) {
    std::size_t reached = at + 1;
    float least = grid_.clearanceAlong(points[at], points[reached]);
    for (std::size_t next = reached + 1; next < points.size(); ++next) {
      if (patience_.isOverAfter(next - at)) return {};
      least = std::min(least, grid_.clearanceAlong(points[next - 1], points[next]));
      if (grid_.clearanceAlong(points[at], points[next]) < shortcutClearance(least)) break;
      reached = next;
    }
    corners.push_back(points[reached]);
    at = reached;
  }
  return corners;
}

}  // namespace casepush
