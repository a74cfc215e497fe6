#include "goal_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/world/shadow.h"
#include "origin_distance.h"

namespace casepush {
namespace {

// So much an object may seem to overlap another where it stands: poses are estimates.
constexpr double kTolerated_m = 0.05;
constexpr double kCell_m = 0.2;
constexpr double kBeyond_m = 3.0;    // It looks half as far again as the start is, and this.
constexpr double kSpacious_m = 0.3;  // More clearance than this, around the object, is not better.
// Of a way through an open cell.
constexpr double kHalfStraight = 12.0;
constexpr double kHalfDiagonal = 17.0;
constexpr int kStraight = static_cast<int>(2.0 * kHalfStraight);
constexpr int kDiagonal = static_cast<int>(2.0 * kHalfDiagonal);
constexpr int kLongestStep = static_cast<int>(kDiagonal * ObjectRoom::kTight);
constexpr float kUnknown = -std::numeric_limits<float>::infinity();  // length of a way

}  // namespace

ObjectRoom::ObjectRoom(const CollisionChecker::Columns& columns, const Solid& object,
                       const Patience& patience)
    : origin_m_(columns.origin_m),
      side_(std::max(1, static_cast<int>(std::lround(kCell_m / columns.resolution_m)))),
      cell_m_(side_ * columns.resolution_m),
      width_((columns.width + side_ - 1) / side_),
      height_((columns.height + side_ - 1) / side_),
      inner_(innerDiscs(object)),
      outer_(travelDiscs(object, 0.0)),
      reach_m_(circumscribedRadius(object)),
      factors_(static_cast<std::size_t>(width_) * height_, 0.0F) {
  look(columns, {0, columns.width - 1, 0, columns.height - 1}, patience);
  setLandmarks(patience);
}

ObjectRoom ObjectRoom::updated(const CollisionChecker::Columns& columns,
                               const CollisionChecker::Area& changed) const {
  ObjectRoom result(*this);
  // No inner disc reaches farther than the outer ones.
  CellBox box = ClearanceGrid::affected(columns, outer_, changed);
  if (box.empty()) return result;
  box = {box.x0 / side_ * side_, std::min(columns.width - 1, box.x1 / side_ * side_ + side_ - 1),
         box.y0 / side_ * side_, std::min(columns.height - 1, box.y1 / side_ * side_ + side_ - 1)};
  result.look(columns, box, Patience());
  result.landmarks_ = RoomLandmarks();
  return result;
}

// Works out the factors anew; the box ends where cells of this end.
void ObjectRoom::look(const CollisionChecker::Columns& columns, const CellBox& box,
                      const Patience& patience) {
  const ClearanceGrid inside(columns, inner_, box, patience);
  const ClearanceGrid around(columns, outer_, box, patience);
  const auto own = [this](int x, int y) -> float& {
    return factors_[static_cast<std::size_t>(y / side_) * width_ + x / side_];
  };
  for (int y = box.y0; y <= box.y1; y += side_) {
    for (int x = box.x0; x <= box.x1; x += side_) own(x, y) = 0.0F;
  }
  const double half_diagonal_m = columns.resolution_m * M_SQRT1_2;
  for (int cell = 0; cell < inside.size() && !patience.isOverAfter(1); ++cell) {
    if (inside.clearance(cell) < -half_diagonal_m) continue;
    float& value = own(box.x0 + cell % box.width(), box.y0 + cell / box.width());
    const float here = factor(around.clearance(cell));
    value = value > 0.0F ? std::min(value, here) : here;
  }
}

void ObjectRoom::setLandmarks(const Patience& patience) {
  if (!landmarks_.empty()) return;
  RoomLandmarks made(halfSteps({}), width_ + 2, kLongestStep, patience);
  if (!patience.isOver()) landmarks_ = std::move(made);
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
                       apart_m + half_diagonal_m + kTolerated_m < inner.radius_m;
              });
          own = is_blocked ? 0.0F : own > 0.0F ? std::max(own, factor(apart_m - reach_m_)) : 0.0F;
        }
      }
    }
  }
  return result;
}

std::vector<HalfSteps> ObjectRoom::halfSteps(const std::vector<PlacedSolid>& obstacles) const {
  const std::vector<float> factors = this->factors(obstacles);
  const int stride = width_ + 2;
  std::vector<HalfSteps> result(static_cast<std::size_t>(stride) * (height_ + 2));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const float factor = factors[static_cast<std::size_t>(y) * width_ + x];
      result[static_cast<std::size_t>(y + 1) * stride + x + 1] = {
          static_cast<std::uint8_t>(kHalfStraight * factor + 0.5),
          static_cast<std::uint8_t>(kHalfDiagonal * factor + 0.5)};
    }
  }
  return result;
}

RoomLibrary::RoomLibrary(const CollisionChecker& map,
                         const std::map<std::string, ObjectModel>& objects)
    : columns_(map.mapColumns()), objects_(objects) {}

std::shared_ptr<RoomLibrary> RoomLibrary::updated(const CollisionChecker& map,
                                                  const CollisionChecker::Area& changed) {
  auto result = std::make_shared<RoomLibrary>(map, objects_);
  if (!columns_->hasSameExtent(*result->columns_)) return result;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [model, room] : rooms_) {
    result->rooms_.emplace(model, room.updated(*result->columns_, changed));
  }
  return result;
}

const ObjectRoom* RoomLibrary::get(const std::string& model, const Patience& patience) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = rooms_.find(model);
  if (found != rooms_.end()) {
    found->second.setLandmarks(patience);
    return patience.isOver() ? nullptr : &found->second;
  }
  ObjectRoom room(*columns_, objects_.at(model).solid, patience);
  return patience.isOver() ? nullptr : &rooms_.emplace(model, std::move(room)).first->second;
}

GoalGuide::GoalGuide(const ObjectRoom& room, const std::vector<HalfSteps>& half_steps,
                     const Eigen::Vector2d& start_m, const Eigen::Vector2d& goal_m,
                     double tolerance_m)
    : goal_m_(goal_m),
      room_(room),
      stride_(room.width() + 2),
      per_row_((std::uint64_t{1} << kReciprocal) / stride_ + 1),
      low_m_(room.centre(0)),
      last_(room.width() - 1.0, room.height() - 1.0),
      cells_per_m_(1.0 / room.cell()),
      half_steps_(half_steps.data()),
      // The estimate may grow by as much as the step takes.
      flood_(static_cast<int>(half_steps.size()), stride_, 2 * kLongestStep),
      way_m_(half_steps.size(), kUnknown) {
  const int start = cell(start_m);
  const int goal = cell(goal_m);
  for (const int end : {start, goal}) {  // Nearly free, at least.
    if (half_steps_[end].straight != 0) continue;
    if (freed_.empty()) freed_ = half_steps;
    freed_[end] = {kStraight / 2, kDiagonal / 2};
    half_steps_ = freed_.data();
  }
  // To cells that are not free they know no way.
  has_landmarks_ = freed_.empty() && !room_.landmarks().empty();
  start_ = start;
  goal_ = goal;
  start_x_ = start % stride_;
  start_y_ = start / stride_;
  reaches_start_ = reach(start, {goal});
  if (reaches_start_) return;
  flood_.clear();
  std::fill(way_m_.begin(), way_m_.end(), kUnknown);
  reaches_start_ = reach(start, region(tolerance_m));
}

// How long a way from there to the start is at least.
int GoalGuide::estimate(int cell) const {
  if (has_landmarks_) return room_.landmarks().between(start_, cell);
  const int row = rowOf(cell);
  const int across = std::abs(cell - row * stride_ - start_x_);
  const int up = std::abs(row - start_y_);
  return kStraight * std::max(across, up) + (kDiagonal - kStraight) * std::min(across, up);
}

// The goal region may lie on both sides of something.
std::vector<int> GoalGuide::region(double tolerance_m) const {
  std::vector<int> region;
  for (int y = 0; y < room_.height(); ++y) {
    for (int x = 0; x < room_.width(); ++x) {
      const int at = (y + 1) * stride_ + x + 1;
      const double apart_m = (room_.centre(y * room_.width() + x) - goal_m_).norm();
      const bool is_near = apart_m <= tolerance_m + room_.cell() * M_SQRT1_2;
      if (is_near && half_steps_[at].straight > 0) region.push_back(at);
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

bool GoalGuide::reach(int start, const std::vector<int>& goals) {
  const double unit_m = room_.cell() / kStraight;
  is_estimated_ = goals.size() == 1;
  for (const int goal : goals) flood_.begin(goal, is_estimated_ ? estimate(goal) : 0);
  settle(start);
  const int way = flood_.distance()[start];
  if (way == GridFlood::kUnreached) return false;
  const int far = way + way / 2 + static_cast<int>(kBeyond_m / unit_m);
  flood_.setLimit(far);
  far_m_ = static_cast<float>(unit_m * far);
  return true;
}

// Goes on until the way from a cell is known, or it is known to be far.
void GoalGuide::settle(int cell) {
  if (way_m_[cell] >= 0.0F) return;
  if (half_steps_[cell].straight == 0) {
    way_m_[cell] = far_m_;
  } else if (is_estimated_) {
    spread(cell, [this](int at) { return estimate(at); });
  } else {
    spread(cell, [](int) { return 0; });
  }
}

// Says how long the way from a cell is at least.
void GoalGuide::bound(int cell) {
  if (way_m_[cell] != kUnknown) return;
  if (half_steps_[cell].straight == 0 || !has_landmarks_) {
    settle(cell);
    return;
  }
  constexpr float kLeast_m = 1e-3F;
  const double unit_m = room_.cell() / kStraight;
  const auto least_m = static_cast<float>(unit_m * room_.landmarks().between(goal_, cell));
  way_m_[cell] = -std::clamp(least_m, kLeast_m, far_m_);
}

template <typename Estimate>
void GoalGuide::spread(int cell, const Estimate& estimate) {
  const double unit_m = room_.cell() / kStraight;
  flood_.spread(
      [this](int from, int to, bool is_diagonal) {
        return HalfSteps::step(half_steps_[from], half_steps_[to], is_diagonal);
      },
      [this, cell, unit_m](int at, int now) {
        way_m_[at] = static_cast<float>(unit_m * now);
        return at != cell;
      },
      estimate);
  if (way_m_[cell] >= 0.0F) return;
  for (float& way_m : way_m_) way_m = way_m < 0.0F ? far_m_ : way_m;  // Nothing else is reached.
}

}  // namespace casepush
