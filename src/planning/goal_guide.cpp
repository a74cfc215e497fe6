#include "goal_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/world/shadow.h"
#include "origin_distance.h"

namespace casepush {
namespace {

constexpr double kCell_m = 0.2;
constexpr double kSpacious_m = 0.3;  // More clearance than this, around the object, is not better.
constexpr int kStep = 8;             // Steps of a way straight through an open cell.
constexpr int kUnknown = std::numeric_limits<int>::max();
constexpr int kRings = 64;  // More than the steps of the longest edge.

struct Neighbour {
  int dx;
  int dy;
  double length;
};

constexpr std::array<Neighbour, 8> kNeighbours = {{{1, 0, 1.0},
                                                   {-1, 0, 1.0},
                                                   {0, 1, 1.0},
                                                   {0, -1, 1.0},
                                                   {1, 1, M_SQRT2},
                                                   {-1, 1, M_SQRT2},
                                                   {1, -1, M_SQRT2},
                                                   {-1, -1, M_SQRT2}}};

}  // namespace

ObjectRoom::ObjectRoom(const CollisionChecker::Columns& columns, const Solid& object)
    : origin_m_(columns.origin_m), inner_(innerDiscs(object)), reach_m_(0.0) {
  const int side = std::max(1, static_cast<int>(std::lround(kCell_m / columns.resolution_m)));
  cell_m_ = side * columns.resolution_m;
  width_ = (columns.width + side - 1) / side;
  height_ = (columns.height + side - 1) / side;
  reach_m_ = circumscribedRadius(object);
  const ClearanceGrid inside(columns, inner_);
  const ClearanceGrid around(columns, travelDiscs(object, 0.0));
  const double half_diagonal_m = columns.resolution_m * M_SQRT1_2;
  factors_.assign(static_cast<std::size_t>(width_) * height_, 0.0F);
  for (int cell = 0; cell < inside.size(); ++cell) {
    if (inside.clearance(cell) < -half_diagonal_m) continue;
    const int x = cell % columns.width / side;
    const int y = cell / columns.width / side;
    float& own = factors_[static_cast<std::size_t>(y) * width_ + x];
    const float here = factor(around.clearance(cell));
    own = own > 0.0F ? std::min(own, here) : here;
  }
}

float ObjectRoom::factor(double clearance_m) const {
  const double lacking = (kSpacious_m - clearance_m) / (kSpacious_m + reach_m_);
  return static_cast<float>(1.0 + (kTight - 1.0) * std::clamp(lacking, 0.0, 1.0));
}

std::vector<float> ObjectRoom::factors(const std::vector<PlacedSolid>& obstacles) const {
  std::vector<float> result = factors_;
  const double half_diagonal_m = cell_m_ * M_SQRT1_2;
  for (const PlacedSolid& obstacle : obstacles) {
    for (const ConvexPart& part : convexParts(obstacle.solid)) {
      const Shadow shadow = transformed(obstacle.map_T_solid, part.shadow());
      const BoundingDisc disc = boundingDisc(shadow);
      const double range_m = disc.radius_m + reach_m_ + kSpacious_m;
      const Eigen::Vector2d low = index(disc.centre_m - Eigen::Vector2d::Constant(range_m));
      const Eigen::Vector2d high = index(disc.centre_m + Eigen::Vector2d::Constant(range_m));
      for (int y = std::max(0.0, low.y()); y <= std::min(height_ - 1.0, high.y()); ++y) {
        for (int x = std::max(0.0, low.x()); x <= std::min(width_ - 1.0, high.x()); ++x) {
          float& own = result[static_cast<std::size_t>(y) * width_ + x];
          const double apart_m = separation(shadow, centre(y * width_ + x));
          const bool is_blocked =
              std::any_of(inner_.begin(), inner_.end(), [&](const TravelDisc& inner) {
                return part.touches(inner.low_m, inner.high_m) && part.isPrism() &&
                       apart_m + half_diagonal_m < inner.radius_m;
              });
          own = is_blocked ? 0.0F : own > 0.0F ? std::max(own, factor(apart_m - reach_m_)) : 0.0F;
        }
      }
    }
  }
  return result;
}

RoomLibrary::RoomLibrary(const CollisionChecker& map,
                         const std::map<std::string, ObjectModel>& objects)
    : columns_(map.mapColumns()), objects_(objects) {}

const ObjectRoom& RoomLibrary::get(const std::string& model) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = rooms_.find(model);
  if (found != rooms_.end()) return found->second;
  return rooms_.try_emplace(model, *columns_, objects_.at(model).solid).first->second;
}

GoalGuide::GoalGuide(const ObjectRoom& room, const std::vector<PlacedSolid>& obstacles,
                     const Eigen::Vector2d& start_m, const Eigen::Vector2d& goal_m,
                     double tolerance_m)
    : goal_m_(goal_m), room_(room) {
  const int start = cell(start_m);
  const int goal = cell(goal_m);
  std::vector<float> factors = room.factors(obstacles);
  for (const int end : {start, goal}) {
    factors[end] = std::max(factors[end], 1.0F);  // They were found free, at least nearly.
  }
  reaches_start_ = spread(factors, start, {goal});
  if (reaches_start_) return;
  std::vector<int> region;  // It may lie on both sides of something.
  for (int other = 0; other < static_cast<int>(factors.size()); ++other) {
    const double apart_m = (room.centre(other) - goal_m).norm();
    if (factors[other] > 0.0F && apart_m <= tolerance_m + room.cell() * M_SQRT1_2) {
      region.push_back(other);
    }
  }
  reaches_start_ = spread(factors, start, region);
}

int GoalGuide::cell(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d index = room_.index(point_m);
  const int x = static_cast<int>(std::clamp(index.x(), 0.0, room_.width() - 1.0));
  const int y = static_cast<int>(std::clamp(index.y(), 0.0, room_.height() - 1.0));
  return y * room_.width() + x;
}

// Dijkstra's algorithm with a ring of buckets for a queue (Dial, 1969).
bool GoalGuide::spread(const std::vector<float>& factors, int start,
                       const std::vector<int>& goals) {
  std::vector<std::vector<int>> ring(kRings);
  const auto more = static_cast<int>(3.0 / room_.cell() * kStep);
  int limit = kUnknown;
  auto waiting = static_cast<int>(goals.size());
  steps_.assign(factors.size(), kUnknown);
  for (const int goal : goals) steps_[goal] = 0;
  ring[0] = goals;
  int now = 0;
  for (; waiting > 0 && now < limit; ++now) {
    std::vector<int>& bucket = ring[now % kRings];
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const int cell = bucket[i];
      if (steps_[cell] != now) continue;
      if (cell == start) limit = now + now / 2 + more;
      const int x = cell % room_.width();
      const int y = cell / room_.width();
      for (const Neighbour& to : kNeighbours) {
        const bool inside = x + to.dx >= 0 && y + to.dy >= 0 && x + to.dx < room_.width() &&
                            y + to.dy < room_.height();
        const int next = cell + to.dy * room_.width() + to.dx;
        if (!inside || factors[next] <= 0.0F) continue;
        const double cost = 0.5 * (factors[cell] + factors[next]) * to.length * kStep;
        const int reached = now + static_cast<int>(cost + 0.5);
        if (reached >= steps_[next]) continue;
        steps_[next] = reached;
        ring[reached % kRings].push_back(next);
        ++waiting;
      }
    }
    waiting -= static_cast<int>(bucket.size());
    bucket.clear();
  }
  farthest_ = now;
  return limit != kUnknown;
}

// Bilinear between the centres of cells.
double GoalGuide::at(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d index = room_.index(point_m);
  const double fx = std::clamp(index.x() - 0.5, 0.0, room_.width() - 1.001);
  const double fy = std::clamp(index.y() - 0.5, 0.0, room_.height() - 1.001);
  const int x = static_cast<int>(fx);
  const int y = static_cast<int>(fy);
  const auto steps = [this](int cx, int cy) {
    const std::size_t cell =
        static_cast<std::size_t>(std::min(cy, room_.height() - 1)) * room_.width() +
        std::min(cx, room_.width() - 1);
    return static_cast<double>(std::min(steps_[cell], farthest_));
  };
  const double tx = fx - x;
  const double ty = fy - y;
  const double value = (1.0 - ty) * ((1.0 - tx) * steps(x, y) + tx * steps(x + 1, y)) +
                       ty * ((1.0 - tx) * steps(x, y + 1) + tx * steps(x + 1, y + 1));
  return std::max(value / kStep * room_.cell(), (point_m - goal_m_).norm());
}

}  // namespace casepush
