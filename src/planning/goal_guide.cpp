#include "goal_guide.h"

#include <algorithm>
#include <cmath>

#include "casepush/world/shadow.h"
#include "grid_flood.h"
#include "origin_distance.h"

namespace casepush {
namespace {

constexpr double kCell_m = 0.2;
constexpr double kBeyond_m = 3.0;    // It looks half as far again as the start is, and this.
constexpr double kSpacious_m = 0.3;  // More clearance than this, around the object, is not better.
// Halves of the lengths of a way through an open cell, in whole numbers: a step takes those of both
// its cells.
constexpr double kHalfStraight = 12.0;
constexpr double kHalfDiagonal = 17.0;
constexpr int kLongestStep = static_cast<int>(2.0 * kHalfDiagonal * ObjectRoom::kTight);

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

GoalGuide::GoalGuide(const ObjectRoom& room, const std::vector<float>& factors,
                     const Eigen::Vector2d& start_m, const Eigen::Vector2d& goal_m,
                     double tolerance_m)
    : goal_m_(goal_m),
      room_(room),
      stride_(room.width() + 2),
      low_m_(room.centre(0)),
      last_(room.width() - 1.0, room.height() - 1.0),
      cells_per_m_(1.0 / room.cell()) {
  const std::size_t cells = static_cast<std::size_t>(stride_) * (room.height() + 2);
  std::vector<Halves> halves(cells);  // with a rim
  const int start = cell(start_m);
  const int goal = cell(goal_m);
  for (int y = 0; y < room.height(); ++y) {
    for (int x = 0; x < room.width(); ++x) {
      const int at = (y + 1) * stride_ + x + 1;
      float factor = factors[static_cast<std::size_t>(y) * room.width() + x];
      if (at == start || at == goal) factor = std::max(factor, 1.0F);  // Nearly free, at least.
      halves[at] = {static_cast<std::uint8_t>(kHalfStraight * factor + 0.5),
                    static_cast<std::uint8_t>(kHalfDiagonal * factor + 0.5)};
    }
  }
  reaches_start_ = spread(halves, start, {goal});
  if (!reaches_start_) reaches_start_ = spread(halves, start, region(halves, tolerance_m));
}

// It may lie on both sides of something.
std::vector<int> GoalGuide::region(const std::vector<Halves>& halves, double tolerance_m) const {
  std::vector<int> region;
  for (int y = 0; y < room_.height(); ++y) {
    for (int x = 0; x < room_.width(); ++x) {
      const int at = (y + 1) * stride_ + x + 1;
      const double apart_m = (room_.centre(y * room_.width() + x) - goal_m_).norm();
      const bool is_near = apart_m <= tolerance_m + room_.cell() * M_SQRT1_2;
      if (is_near && halves[at].straight > 0) region.push_back(at);
    }
  }
  return region;
}

int GoalGuide::cell(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d index = room_.index(point_m);
  const int x = static_cast<int>(std::clamp(index.x(), 0.0, room_.width() - 1.0));
  const int y = static_cast<int>(std::clamp(index.y(), 0.0, room_.height() - 1.0));
  return (y + 1) * stride_ + x + 1;
}

bool GoalGuide::spread(const std::vector<Halves>& halves, int start,
                       const std::vector<int>& goals) {
  const double unit_m = 0.5 * room_.cell() / kHalfStraight;
  const auto more = static_cast<int>(kBeyond_m / unit_m);
  GridFlood flood(static_cast<int>(halves.size()), stride_, kLongestStep);
  for (const int goal : goals) flood.begin(goal);
  int limit = GridFlood::kUnreached;
  const int farthest = flood.spread(
      [&halves](int from, int to, bool is_diagonal) {
        if (halves[to].straight == 0) return 0;
        return is_diagonal ? halves[from].diagonal + halves[to].diagonal
                           : halves[from].straight + halves[to].straight;
      },
      [&limit, start, more](int at, int now) {
        if (at == start) limit = now + now / 2 + more;
        return now < limit;
      });
  way_m_.resize(halves.size());
  for (std::size_t at = 0; at < halves.size(); ++at) {
    way_m_[at] = static_cast<float>(unit_m * std::min(flood.distance()[at], farthest));
  }
  return limit != GridFlood::kUnreached;
}

}  // namespace casepush
