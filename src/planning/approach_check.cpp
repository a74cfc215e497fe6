#include "approach_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/common/same_pose.h"
#include "push_start.h"
#include "straight_motion.h"

namespace casepush {
namespace {

constexpr std::size_t kEnoughEnds = 2;
constexpr int kMostLines = 12;     // Straight ways to be tested for one end of an approach.
constexpr int kNearby = 4000;      // Cells to look at for a way around the object.
constexpr double kBeside_m = 1.6;  // Most that is asked for lies no farther from the object.

// What is reached from one end of a way is reached from others near it, mostly.
bool isApart(const std::vector<Eigen::Vector2d>& ends, const Eigen::Vector2d& end) {
  constexpr double kApart_m = 0.4;
  return std::none_of(ends.begin(), ends.end(), [&end](const Eigen::Vector2d& other) {
    return (other - end).norm() < kApart_m;
  });
}

// So many steps may be left out if nothing is in the way of that length.
int stepsWithin(double free_m, double step_m) {
  return free_m > 0.0 && step_m > 0.0 ? static_cast<int>(std::min(1e6, free_m / step_m)) : 0;
}

}  // namespace

ApproachCheck::ApproachCheck(ApproachLibrary* library, const ClearanceGrid& grid,
                             const CollisionChecker& checker,
                             const std::vector<PlacedObject>& obstacles, Patience patience,
                             const std::shared_ptr<const void>& owner)
    : library_(*library),
      grid_(grid),
      checker_(checker),
      patience_(std::move(patience)),
      flood_(library->borrowFlood(grid.size())),
      known_(library->borrowKnown(owner)) {
  for (const PlacedObject& obstacle : obstacles) {
    obstacles_.push_back(standing(library_.clearance(obstacle.model), obstacle.map_T_object));
  }
}

ApproachCheck::~ApproachCheck() {
  library_.giveBack(std::move(flood_));
  library_.giveBack(std::move(known_));
}

ApproachCheck::Standing ApproachCheck::standing(const ObjectClearance& clearance,
                                                const Pose2& map_T_object) {
  return {&clearance, PushStart(map_T_object), map_T_object.position()};
}

void ApproachCheck::standAt(const PlacedObject& object) {
  object_ = standing(library_.clearance(object.model), object.map_T_object);
  near_.clear();
  for (const Standing& obstacle : obstacles_) {
    if (obstacle.isWithin(obstacle.clearance->reach() + kBeside_m, object_->position_m)) {
      near_.push_back(&obstacle);
    }
  }
}

// The library keeps them by content, which takes long to compare.
const ApproachCheck::Ways& ApproachCheck::waysOf(const std::string& model,
                                                 const PreparedCase& push_case) {
  std::shared_ptr<const Ways>& ways = known_->ways[&push_case];
  if (!ways) ways = library_.ways(model, push_case);
  return *ways;
}

bool ApproachCheck::isDirect(const std::string& model, const PreparedCase& previous,
                             const PreparedCase& next) {
  std::unordered_map<const PreparedCase*, bool>& known = known_->direct[&previous];
  const auto found = known.find(&next);
  if (found != known.end()) return found->second;
  return known.emplace(&next, library_.isDirect(model, previous, next)).first->second;
}

float ApproachCheck::clearanceAround(int cell, const Eigen::Vector2d& centre_m,
                                     float enough_m) const {
  float clear_m = grid_.clearance(cell);
  if (clear_m < enough_m) return clear_m;
  const bool is_beside = object_->isWithin(kBeside_m, centre_m);
  const std::size_t count = is_beside ? near_.size() : obstacles_.size();
  for (std::size_t i = 0; i < count && clear_m >= enough_m; ++i) {
    const Standing& obstacle = is_beside ? *near_[i] : obstacles_[i];
    clear_m = std::min(clear_m, obstacle.at(centre_m));
  }
  return clear_m;
}

bool ApproachCheck::canPass(int cell, const Eigen::Vector2d& centre_m) const {
  const auto least_m = static_cast<float>(library_.minClearance());
  return clearanceAround(cell, centre_m, least_m) >= least_m && object_->at(centre_m) >= least_m;
}

bool ApproachCheck::isFreeLine(const Pose2& from, const Pose2& to) const {
  constexpr double kStep_m = 0.01;
  const double length_m = distance(from, to);
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kStep_m)));
  const double step_m = length_m / steps;
  const auto half_diagonal_m = static_cast<float>(grid_.resolution() * M_SQRT1_2);
  const Eigen::Vector2d along = (to.position() - from.position()) / steps;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d point = from.position() + i * along;
    const ClearanceGrid::Place at = grid_.locate(point);
    // Free whichever way the robot faces. The object itself was looked at on the open floor.
    const float clear_m =
        at.cell >= 0 ? clearanceAround(at.cell, at.centre_m, half_diagonal_m) : -1.0F;
    if (clear_m >= half_diagonal_m) {
      i += stepsWithin(clear_m - half_diagonal_m - (point - at.centre_m).norm(), step_m);
    } else if (checker_.collides(library_.docking(),
                                 between(from, to, static_cast<double>(i) / steps))) {
      return false;
    }
  }
  return true;
}

bool ApproachCheck::canTravelAt(const Eigen::Vector2d& point) const {
  const ClearanceGrid::Place at = grid_.locate(point);
  if (at.cell < 0) return false;
  const auto needed_m =
      static_cast<float>(std::max(library_.minClearance(), (at.centre_m - point).norm()));
  return clearanceAround(at.cell, at.centre_m, needed_m) >= needed_m &&
         object_->at(at.centre_m) >= needed_m;
}

bool ApproachCheck::canGoStraight(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  return isClearLine(from, to, &*object_);
}

// From cell to neighbouring cell, but for those that are clear because one before them is by far.
// Without `object` the line keeps away from it.
bool ApproachCheck::isClearLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                const Standing* object) const {
  const double length_m = (to - from).norm();
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / grid_.resolution())));
  const double step_m = length_m / steps;
  const Eigen::Vector2d along = (to - from) / steps;
  const auto least_m = static_cast<float>(library_.minClearance());
  const double lost_m = least_m + grid_.resolution() * M_SQRT1_2 + ObjectClearance::kRounding_m;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d point = from + i * along;
    const ClearanceGrid::Place at = grid_.locate(point);
    if (at.cell < 0) return false;
    float clear_m = clearanceAround(at.cell, at.centre_m, least_m);
    if (object != nullptr) clear_m = std::min(clear_m, object->at(at.centre_m));
    if (clear_m < least_m) return false;
    i += stepsWithin(clear_m - lost_m - (point - at.centre_m).norm(), step_m);
  }
  return true;
}

// Straight away from the object, around it, and straight towards it.
bool ApproachCheck::canGoAround(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                double turn_rad) const {
  constexpr double kChord_rad = 0.3;
  const Eigen::Vector2d& centre = object_->position_m;
  const Eigen::Vector2d away = from - centre;
  const double begin_rad = std::atan2(away.y(), away.x());
  const double beside_m =
      object_->clearance->beside() + library_.minClearance() + grid_.resolution();
  const double radius_m = std::max(away.norm(), beside_m / std::cos(kChord_rad / 2.0));
  const auto onArc = [&](double angle_rad) -> Eigen::Vector2d {
    return centre + radius_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
  };
  Eigen::Vector2d last = onArc(begin_rad);
  if (!canGoStraight(from, last)) return false;
  const int chords = std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad) / kChord_rad)));
  for (int i = 1; i <= chords; ++i) {
    const Eigen::Vector2d next = onArc(begin_rad + turn_rad * i / chords);
    if (!isClearLine(last, next, nullptr)) return false;
    last = next;
  }
  return canGoStraight(last, to);
}

// Mostly a simple way will do, and is found much faster than by looking at cell after cell.
bool ApproachCheck::canGoPlainly(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
  if (canGoStraight(from, to)) return true;
  const Eigen::Vector2d a = from - object_->position_m;
  const Eigen::Vector2d b = to - object_->position_m;
  const double turn_rad = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  const double other_rad = turn_rad > 0.0 ? turn_rad - 2.0 * M_PI : turn_rad + 2.0 * M_PI;
  return canGoAround(from, to, turn_rad) || canGoAround(from, to, other_rad);
}

std::optional<bool> ApproachCheck::canGo(Ends* from, Ends* to) {
  find(1, to);
  if (to->found.empty()) return false;
  find(1, from);
  if (from->found.empty()) return false;
  if (canGoPlainly(from->found.front(), to->found.front())) return true;
  find(kEnoughEnds, from);
  find(kEnoughEnds, to);
  return connects(*from, *to);
}

// From both ends at once, each best first, until they meet or one of them has nothing left: the
// smaller of two separate places decides soon.
std::optional<bool> ApproachCheck::connects(const Ends& from, const Ends& to) {
  ApproachLibrary::Flood& flood = *flood_;
  const std::uint32_t one = ++flood.round;
  const std::uint32_t other = ++flood.round;
  const std::uint32_t blocked = ++flood.round;
  Front ahead{one, other, blocked, to.found.front(), flood.ahead};
  Front back{other, one, blocked, from.found.front(), flood.back};
  bool met = begin(from, ahead);
  met = begin(to, back) || met;
  for (int looked = 0; !met; ++looked) {
    if (looked == kNearby) return std::nullopt;
    Front& front = looked % 2 == 0 ? ahead : back;
    if (front.open.empty()) return false;
    met = advance(front);
  }
  return met;
}

// All that the robot gets to is looked through once, however many pushes it might begin with, and
// only as far as somebody asks.
bool ApproachCheck::connectsFromAfar(const Ends& to) {
  constexpr std::size_t kSteps = 20;  // Of a cell with its neighbours.
  const auto note = [this](int cell) {
    if (reached_[cell] != 0 || !canPass(cell, grid_.centre(cell))) return;
    reached_[cell] = 1;
    reached_cells_.push_back(cell);
  };
  if (reached_.empty()) {
    reached_.assign(grid_.size(), 0);
    reached_cells_.clear();
    reached_done_ = 0;
    for (const Eigen::Vector2d& end : begun_ends_.found) note(grid_.cell(end));
  }
  const auto is_there = [&] {
    return std::any_of(to.found.begin(), to.found.end(),
                       [this](const auto& end) { return reached_[grid_.cell(end)] != 0; });
  };
  while (!is_there()) {
    if (reached_done_ == reached_cells_.size() || patience_.isOverAfter(kSteps)) return false;
    const int cell = reached_cells_[reached_done_++];
    const int x = cell % grid_.width();
    const int y = cell / grid_.width();
    for (int dy = y > 0 ? -1 : 0; dy <= (y + 1 < grid_.height() ? 1 : 0); ++dy) {
      for (int dx = x > 0 ? -1 : 0; dx <= (x + 1 < grid_.width() ? 1 : 0); ++dx) {
        note(cell + dy * grid_.width() + dx);
      }
    }
  }
  return true;
}

bool ApproachCheck::begin(const Ends& ends, Front& front) {
  front.open.clear();
  bool met = false;
  for (const Eigen::Vector2d& end : ends.found) met = visit(grid_.locate(end), front) || met;
  return met;
}

bool ApproachCheck::advance(Front& front) {
  std::pop_heap(front.open.begin(), front.open.end(), std::greater<>());
  const int cell = front.open.back().second;
  front.open.pop_back();
  const int x = cell % grid_.width();
  const int y = cell / grid_.width();
  bool met = false;
  for (int dy = y > 0 ? -1 : 0; dy <= (y + 1 < grid_.height() ? 1 : 0); ++dy) {
    for (int dx = x > 0 ? -1 : 0; dx <= (x + 1 < grid_.width() ? 1 : 0); ++dx) {
      const int next = cell + dy * grid_.width() + dx;
      met = visit({next, grid_.centre(x + dx, y + dy)}, front) || met;
    }
  }
  return met;
}

// True if the other front has been there.
bool ApproachCheck::visit(const ClearanceGrid::Place& place, Front& front) {
  std::uint32_t& visited = flood_->visited[place.cell];
  if (visited == front.round || visited == front.blocked) return false;
  if (visited == front.other_round) return true;
  if (!canPass(place.cell, place.centre_m)) {
    visited = front.blocked;
    return false;
  }
  visited = front.round;
  front.open.emplace_back((place.centre_m - front.towards).squaredNorm(), place.cell);
  std::push_heap(front.open.begin(), front.open.end(), std::greater<>());
  return false;
}

void ApproachCheck::find(std::size_t wanted, Ends* ends) const {
  if (ends->ways == nullptr) return;
  const PushStart& object = object_->map_T_object;
  for (; ends->looked < ends->ways->size(); ++ends->looked) {
    if (ends->found.size() >= wanted || ends->lines >= kMostLines) return;
    const Pose2& object_T_end = (*ends->ways)[ends->looked];
    const Eigen::Vector2d end = object.positionOf(object_T_end);
    if (!isApart(ends->found, end) || !canTravelAt(end)) continue;
    ++ends->lines;
    if (isFreeLine(object * ends->docked, object * object_T_end)) ends->found.push_back(end);
  }
}

bool ApproachCheck::canFollow(const PlacedObject& object, const PreparedCase& previous,
                              const PreparedCase& next) {
  standAt(object);
  const PushStart& start = object_->map_T_object;
  if (isDirect(object.model, previous, next) &&
      isFreeLine(start * previous.outcome_T_robot, start * next.robot_begin)) {
    return true;
  }
  Ends to{next.robot_begin, &waysOf(object.model, next).object_T_predock, 0, 0, {}};
  return canGo(&waysOut(object, previous), &to).value_or(false);
}

bool ApproachCheck::canReach(const PlacedObject& object, const Pose2& map_T_robot,
                             const PreparedCase& next) {
  standAt(object);
  Ends to{next.robot_begin, &waysOf(object.model, next).object_T_predock, 0, 0, {}};
  find(1, &to);
  if (to.found.empty()) return false;
  Ends& from = waysFrom(object, map_T_robot);
  if (!reached_.empty()) {  // A longer search has begun.
    if (canGoPlainly(from.found.front(), to.found.front())) return true;
    find(kEnoughEnds, &to);
    return connectsFromAfar(to);
  }
  const std::optional<bool> can = canGo(&from, &to);
  return can ? *can : connectsFromAfar(to);
}

// Several pushes are tried after one another.
ApproachCheck::Ends& ApproachCheck::waysOut(const PlacedObject& object,
                                            const PreparedCase& previous) {
  const Pose2& pose = object.map_T_object;
  if (left_ && left_->second == &previous && isSame(left_->first, pose)) return left_ends_;
  left_.emplace(pose, &previous);
  left_ends_ = {
      previous.outcome_T_robot, &waysOf(object.model, previous).object_T_undocked, 0, 0, {}};
  return left_ends_;
}

// Where the robot gets straight from where it stands, e.g. at the object's side.
ApproachCheck::Ends& ApproachCheck::waysFrom(const PlacedObject& object, const Pose2& map_T_robot) {
  if (begun_ && isSame(begun_->first, map_T_robot) && isSame(begun_->second, object.map_T_object)) {
    return begun_ends_;
  }
  begun_.emplace(map_T_robot, object.map_T_object);
  begun_ends_ = {};
  reached_.clear();
  std::vector<Eigen::Vector2d>& found = begun_ends_.found;
  if (canTravelAt(map_T_robot.position())) {
    found.push_back(map_T_robot.position());
    return begun_ends_;
  }
  CollisionChecker checker = checker_;
  std::vector<PlacedSolid> all = checker_.obstacles();
  all.push_back({library_.solid(object.model), object.map_T_object});
  checker.setObstacles(std::move(all));
  library_.waysOut(checker, map_T_robot, [&](const Pose2& end) {
    if (isApart(found, end.position()) && canTravelAt(end.position())) {
      found.push_back(end.position());
    }
    return found.size() < kEnoughEnds;
  });
  return begun_ends_;
}

}  // namespace casepush
