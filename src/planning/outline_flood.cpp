#include "outline_flood.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kHeading_rad = 2.0 * M_PI / Sweep::kHeadings;
constexpr int kMostCells = 300000;       // To be looked at.
constexpr std::size_t kFewSteps = 20;    // For Patience: of a cell with its neighbours,
constexpr std::size_t kManySteps = 700;  // and of one where all headings are tested.

std::vector<Track> standing(std::shared_ptr<const Footprint> object) {
  return {{std::move(object), {Pose2()}, Track::Kind::kSeparate}};
}

}  // namespace

OutlineFlood::Headings OutlineFlood::Headings::turned(int by) const {
  const auto& [low, high] = words;
  if (by > 0) return {{low << 1 | high >> 63, high << 1 | low >> 63}};
  return {{low >> 1 | high << 63, high >> 1 | low << 63}};
}

OutlineFlood::OutlineFlood(const OutlineProblem& problem, const ClearanceField& clearance,
                           const Patience& patience)
    : problem_(problem),
      clearance_(clearance),
      patience_(patience),
      columns_(problem.sweeps.collisions().columns()),
      outline_(standing(problem.object), problem.sweeps.classes()),
      step_cells_(std::max(1, static_cast<int>(std::ceil(problem.step_m / columns_.resolution_m)))),
      step_headings_(std::max(1, static_cast<int>(std::ceil(problem.step_rad / kHeading_rad)))),
      pages_across_((columns_.width + kPage - 1) / kPage),
      pages_(static_cast<std::size_t>(pages_across_) * ((columns_.height + kPage - 1) / kPage)) {
  fronts_[kFromStart].towards_m = problem.map_T_goal.position();
  fronts_[kFromGoal].towards_m = problem.map_T_start.position();
  beginAtStart();
  beginAtGoal();
  run();
}

Eigen::Vector2d OutlineFlood::centre(int x, int y) const {
  return columns_.origin_m + columns_.resolution_m * Eigen::Vector2d(x + 0.5, y + 0.5);
}

void OutlineFlood::run() {
  while (!met_) {
    for (const int end : {kFromStart, kFromGoal}) {
      if (patience_.isOverAfter(kFewSteps) || known_cells_ > kMostCells || met_) return;
      if (fronts_[end].cells.empty()) {
        shut_ = end;
        return;
      }
      advance(end);
    }
  }
}

void OutlineFlood::beginAtStart() {
  const Eigen::Vector2d index =
      (problem_.map_T_start.position() - columns_.origin_m) / columns_.resolution_m;
  const int x = std::clamp(static_cast<int>(std::floor(index.x())), 0, columns_.width - 1);
  const int y = std::clamp(static_cast<int>(std::floor(index.y())), 0, columns_.height - 1);
  Headings heading;
  heading.set(Sweep::heading(problem_.map_T_start.yaw()));
  // It stands there, whatever is said of it.
  Cell& cell = at(x, y);
  cell.free = cell.free | heading;
  reach(kFromStart, x, y, heading);
}

void OutlineFlood::beginAtGoal() {
  const GoalTolerance& tolerance = problem_.tolerance;
  Headings headings;
  for (int i = 0; i < Sweep::kHeadings; ++i) {
    const double off_rad = std::abs(wrapAngle(i * kHeading_rad - problem_.map_T_goal.yaw()));
    if (off_rad <= tolerance.yaw_rad + kHeading_rad) headings.set(i);
  }
  const double reach_m = tolerance.position_m + columns_.resolution_m;
  const Eigen::Vector2d goal_m = problem_.map_T_goal.position();
  const Eigen::Array2d low = (goal_m - columns_.origin_m).array() - reach_m;
  const Eigen::Array2d high = (goal_m - columns_.origin_m).array() + reach_m;
  const auto index = [this](double metres, int count) {
    return static_cast<int>(std::clamp(metres / columns_.resolution_m, 0.0, count - 1.0));
  };
  for (int y = index(low.y(), columns_.height); y <= index(high.y(), columns_.height); ++y) {
    for (int x = index(low.x(), columns_.width); x <= index(high.x(), columns_.width); ++x) {
      if (patience_.isOver() || known_cells_ > kMostCells) return;
      if ((centre(x, y) - goal_m).norm() <= reach_m) reach(kFromGoal, x, y, headings);
    }
  }
}

void OutlineFlood::reach(int end, int x, int y, const Headings& headings) {
  Cell& cell = at(x, y);
  const Headings fresh = headings & cell.free & ~cell.reached[end];
  if (!fresh.any()) return;
  cell.reached[end] = cell.reached[end] | fresh;
  met_ = met_ || (fresh & cell.reached[1 - end]).any();
  if (!cell.waiting[end].any()) {
    const auto ahead = static_cast<float>((centre(x, y) - fronts_[end].towards_m).squaredNorm());
    fronts_[end].cells.emplace(ahead, y * columns_.width + x);
  }
  cell.waiting[end] = cell.waiting[end] | fresh;
}

void OutlineFlood::advance(int end) {
  const int index = fronts_[end].cells.top().second;
  fronts_[end].cells.pop();
  const int x = index % columns_.width;
  const int y = index / columns_.width;
  const Headings headings = spread(std::exchange(at(x, y).waiting[end], {}));
  const int last_x = std::min(columns_.width - 1, x + step_cells_);
  const int last_y = std::min(columns_.height - 1, y + step_cells_);
  for (int to_y = std::max(0, y - step_cells_); to_y <= last_y; ++to_y) {
    for (int to_x = std::max(0, x - step_cells_); to_x <= last_x; ++to_x) {
      reach(end, to_x, to_y, headings);
    }
  }
}

OutlineFlood::Headings OutlineFlood::spread(Headings headings) const {
  for (int i = 0; i < step_headings_; ++i) {
    headings = headings | headings.turned(1) | headings.turned(-1);
  }
  return headings;
}

OutlineFlood::Cell& OutlineFlood::at(int x, int y) {
  std::unique_ptr<Page>& page =
      pages_[static_cast<std::size_t>(y / kPage) * pages_across_ + x / kPage];
  if (!page) page = std::make_unique<Page>();
  Cell& cell = (*page)[y % kPage * kPage + x % kPage];
  if (!cell.is_known) {
    cell.is_known = true;
    cell.free = freeAt(x, y);
    ++known_cells_;
  }
  return cell;
}

OutlineFlood::Headings OutlineFlood::freeAt(int x, int y) const {
  const Headings all = ~Headings();
  const Eigen::Vector2d point = centre(x, y);
  const double off_m = (point - problem_.map_T_start.position()).norm();
  const bool is_lenient =
      problem_.lenient_m > 0.0 && off_m <= problem_.lenient_m + columns_.resolution_m;
  if (is_lenient || clearance_.at(point) >= problem_.radius_m) return all;
  patience_.isOverAfter(kManySteps);
  Headings free;
  for (int i = 0; i < Sweep::kHeadings; ++i) {
    const Pose2 pose(point.x(), point.y(), wrapAngle(i * kHeading_rad));
    if (!problem_.sweeps.certainlyCollides(outline_, pose)) free.set(i);
  }
  return free;
}

bool OutlineFlood::hasReached(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d index = (point_m - columns_.origin_m) / columns_.resolution_m;
  const bool is_inside = index.x() >= 0.0 && index.y() >= 0.0 && index.x() < columns_.width &&
                         index.y() < columns_.height;
  if (!is_inside) return false;
  const int x = static_cast<int>(index.x());
  const int y = static_cast<int>(index.y());
  const auto& page = pages_[static_cast<std::size_t>(y / kPage) * pages_across_ + x / kPage];
  return page && (*page)[y % kPage * kPage + x % kPage].reached[shut_].any();
}

}  // namespace casepush
