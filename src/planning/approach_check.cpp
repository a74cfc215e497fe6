#include "approach_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "casepush/world/shadow.h"
#include "straight_motion.h"

namespace casepush {
namespace {

constexpr double kNode_m = 0.02;     // Spacing of a table's nodes.
constexpr double kRange_m = 0.3;     // Clearance is exact up to this.
constexpr double kOpenHalf_m = 5.0;  // Of the square without anything else.
constexpr double kFar_m = 3.5;       // Clear of any object there.

Map openMap(double resolution_m) {
  WorldModel world;
  world.name = "open floor";
  world.min_m = {-kOpenHalf_m, -kOpenHalf_m};
  world.max_m = {kOpenHalf_m, kOpenHalf_m};
  Map map(resolution_m);
  map.addSurvey(surveyPoints(world, resolution_m));
  return map;
}

/// Bytes of the numbers, as a key.
std::string keyOf(const std::string& model, const PreparedCase& push_case) {
  std::string key = model;
  const auto append = [&key](double value) {
    char bytes[sizeof(double)];
    std::memcpy(bytes, &value, sizeof(value));
    key.append(bytes, sizeof(bytes));
  };
  for (const Pose2& pose : {push_case.robot_begin, push_case.outcome_T_robot}) {
    append(pose.x());
    append(pose.y());
    append(pose.yaw());
  }
  append(push_case.push_direction_rad);
  return key;
}

}  // namespace

ObjectClearance::ObjectClearance(const Solid& object, const std::vector<TravelDisc>& discs) {
  double widest_m = 0.0;
  for (const TravelDisc& disc : discs) widest_m = std::max(widest_m, disc.radius_m);
  reach_m_ = circumscribedRadius(object) + widest_m + kRange_m;
  side_ = 2 * static_cast<int>(std::ceil(reach_m_ / kNode_m)) + 1;
  clearance_m_.assign(static_cast<std::size_t>(side_) * side_, static_cast<float>(kRange_m));
  for (const ConvexPart& part : convexParts(object)) {
    for (const TravelDisc& disc : discs) {
      const Shadow shadow = part.shadow(disc.low_m, disc.high_m);
      if (shadow.empty()) continue;
      const BoundingDisc around = boundingDisc(shadow);
      for (int i = 0; i < side_ * side_; ++i) {
        const Eigen::Vector2d node =
            kNode_m * Eigen::Vector2d(i % side_ - side_ / 2, i / side_ - side_ / 2);
        const double least_m = (node - around.centre_m).norm() - around.radius_m - disc.radius_m;
        if (least_m >= clearance_m_[i]) continue;
        const double clear_m = separation(shadow, node) - disc.radius_m;
        clearance_m_[i] = std::min(clearance_m_[i], static_cast<float>(clear_m));
      }
    }
  }
  // Nowhere is the clearance less than at the next node, minus the way there.
  for (float& value : clearance_m_) value -= static_cast<float>(kNode_m * M_SQRT1_2);
}

float ObjectClearance::at(const Eigen::Vector2d& object_point_m) const {
  const int x = static_cast<int>(std::lround(object_point_m.x() / kNode_m)) + side_ / 2;
  const int y = static_cast<int>(std::lround(object_point_m.y() / kNode_m)) + side_ / 2;
  if (x < 0 || y < 0 || x >= side_ || y >= side_) return static_cast<float>(kRange_m);
  return clearance_m_[static_cast<std::size_t>(y) * side_ + x];
}

ApproachLibrary::ApproachLibrary(const CollisionChecker& map, const RobotModel& robot,
                                 const ObjectModels& objects, const RobotPathOptions& options)
    : objects_(objects),
      discs_(travelDiscs(robot.solid, options.margin_m)),
      grid_(*map.mapColumns(), discs_),
      docking_(map.footprint(robot.solid, options.dock_margin_m)),
      paths_(robot, options),
      open_(openMap(map.columns().resolution_m)),
      min_clearance_m_(std::max(0.0, grid_.resolution() * M_SQRT1_2 - options.margin_m)) {}

const ObjectClearance& ApproachLibrary::clearance(const std::string& model) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<ObjectClearance>& entry = clearances_[model];
  if (!entry) entry = std::make_unique<ObjectClearance>(objects_.at(model).solid, discs_);
  return *entry;
}

ApproachLibrary::Ways ApproachLibrary::ways(const std::string& model,
                                            const PreparedCase& push_case) {
  const std::string key = keyOf(model, push_case);
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto [entry, is_new] = ways_.try_emplace(key);
  if (is_new) entry->second = findWays(model, push_case);
  return entry->second;
}

// Found by the path planner itself, so that the two agree.
ApproachLibrary::Ways ApproachLibrary::findWays(const std::string& model,
                                                const PreparedCase& push_case) const {
  Ways ways;
  CollisionChecker checker = open_;
  checker.setObstacles({{objects_.at(model).solid, Pose2()}});
  const double bearing = std::atan2(push_case.robot_begin.y(), push_case.robot_begin.x());
  const Pose2 far(kFar_m * std::cos(bearing), kFar_m * std::sin(bearing), bearing);
  const RobotPath dock =
      paths_.plan(checker, far, push_case.robot_begin, push_case.push_direction_rad);
  const RobotPath undock = paths_.plan(checker, push_case.outcome_T_robot, far, bearing);
  if (!dock.found || !undock.found || dock.waypoints.size() < 2 || undock.waypoints.size() < 2) {
    return ways;
  }
  ways.known = true;
  // Way points farther away are no longer part of the straight way: the robot needs none.
  constexpr double kLongest_m = 1.5;
  const Pose2& undocked = undock.waypoints[1];
  const Pose2& predock = dock.waypoints[dock.waypoints.size() - 2];
  const bool leaves = distance(undocked, push_case.outcome_T_robot) < kLongest_m;
  const bool docks = distance(predock, push_case.robot_begin) < kLongest_m;
  ways.object_T_undocked =
      farther(checker, push_case.outcome_T_robot, leaves ? undocked : push_case.outcome_T_robot);
  ways.object_T_predock =
      farther(checker, push_case.robot_begin, docks ? predock : push_case.robot_begin);
  return ways;
}

// The path planner turns as soon as it can. A little farther out there is no doubt that it can.
Pose2 ApproachLibrary::farther(const CollisionChecker& checker, const Pose2& docked,
                               const Pose2& apart) const {
  constexpr double kMore_m = 0.08;
  constexpr double kStep_m = 0.01;
  Eigen::Vector2d away = apart.position() - docked.position();
  if (away.norm() < kStep_m) away = docked.position();
  if (away.norm() < kStep_m) return apart;
  away.normalize();
  Pose2 pose = apart;
  for (double more_m = kStep_m; more_m <= kMore_m; more_m += kStep_m) {
    const Eigen::Vector2d next = apart.position() + more_m * away;
    const Pose2 tried(next.x(), next.y(), apart.yaw());
    if (checker.collides(*docking_, tried)) break;
    pose = tried;
  }
  return pose;
}

ApproachCheck::ApproachCheck(ApproachLibrary* library, const CollisionChecker& checker,
                             const std::vector<PlacedObject>& obstacles)
    : library_(*library), checker_(checker), visited_(library->grid().size(), 0) {
  current_.reserve(visited_.size());
  for (int cell = 0; cell < library_.grid().size(); ++cell) {
    current_.push_back(library_.grid().clearance(cell));
  }
  for (const PlacedObject& obstacle : obstacles) {
    stamp(library_.clearance(obstacle.model), obstacle.map_T_object);
  }
  standing_ = current_;
}

ApproachCheck::Window ApproachCheck::stamp(const ObjectClearance& clearance,
                                           const Pose2& map_T_object) {
  const ClearanceGrid& cells = library_.grid();
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(clearance.reach());
  const Eigen::Vector2d low =
      (map_T_object.position() - reach - cells.origin()) / cells.resolution();
  const Eigen::Vector2d high =
      (map_T_object.position() + reach - cells.origin()) / cells.resolution();
  const int x0 = static_cast<int>(std::clamp(low.x(), 0.0, 1.0 * cells.width()));
  const int y0 = static_cast<int>(std::clamp(low.y(), 0.0, 1.0 * cells.height()));
  const int x1 = static_cast<int>(std::clamp(high.x(), -1.0, cells.width() - 1.0));
  const int y1 = static_cast<int>(std::clamp(high.y(), -1.0, cells.height() - 1.0));
  const Pose2 object_T_map = map_T_object.inverse();
  const double cosine = std::cos(object_T_map.yaw());
  const double sine = std::sin(object_T_map.yaw());
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const int cell = y * cells.width() + x;
      const Eigen::Vector2d p = cells.centre(cell);
      const Eigen::Vector2d own(object_T_map.x() + cosine * p.x() - sine * p.y(),
                                object_T_map.y() + sine * p.x() + cosine * p.y());
      current_[cell] = std::min(current_[cell], clearance.at(own));
    }
  }
  return {x0, y0, x1, y1};
}

void ApproachCheck::restore(const Window& window) {
  for (int y = window.y0; y <= window.y1; ++y) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * library_.grid().width();
    if (window.x0 > window.x1) break;
    std::copy(standing_.begin() + row + window.x0, standing_.begin() + row + window.x1 + 1,
              current_.begin() + row + window.x0);
  }
}

bool ApproachCheck::isFreeLine(const Pose2& from, const Pose2& to) const {
  constexpr double kStep_m = 0.01;
  const int steps = std::max(1, static_cast<int>(std::ceil(distance(from, to) / kStep_m)));
  for (int i = 0; i <= steps; ++i) {
    if (checker_.collides(library_.docking(), between(from, to, static_cast<double>(i) / steps))) {
      return false;
    }
  }
  return true;
}

bool ApproachCheck::canTravelAt(const Eigen::Vector2d& point) const {
  const int cell = library_.grid().cell(point);
  if (cell < 0) return false;
  const double needed_m =
      std::max(library_.minClearance(), (library_.grid().centre(cell) - point).norm());
  return current_[cell] >= needed_m;
}

// Breadth first, until the two meet.
bool ApproachCheck::connects(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  if (!canTravelAt(from) || !canTravelAt(to)) return false;
  const int width = library_.grid().width();
  const int height = library_.grid().height();
  const int goal = library_.grid().cell(to);
  const auto least = static_cast<float>(library_.minClearance());
  front_.assign(1, library_.grid().cell(from));
  visited_[front_.front()] = ++round_;
  for (std::size_t next = 0; next < front_.size(); ++next) {
    const int cell = front_[next];
    if (cell == goal) return true;
    const int x = cell % width;
    const int y = cell / width;
    const auto visit = [&](bool inside, int other) {
      if (!inside || visited_[other] == round_ || current_[other] < least) return;
      visited_[other] = round_;
      front_.push_back(other);
    };
    visit(x > 0, cell - 1);
    visit(x + 1 < width, cell + 1);
    visit(y > 0, cell - width);
    visit(y + 1 < height, cell + width);
  }
  return false;
}

bool ApproachCheck::canFollow(const PlacedObject& object, const PreparedCase& previous,
                              const PreparedCase& next) {
  const ApproachLibrary::Ways out = library_.ways(object.model, previous);
  const Pose2& map_T_object = object.map_T_object;
  return out.known &&
         isFreeLine(map_T_object * previous.outcome_T_robot,
                    map_T_object * out.object_T_undocked) &&
         canReach(object, map_T_object * out.object_T_undocked, next);
}

bool ApproachCheck::canReach(const PlacedObject& object, const Pose2& map_T_robot,
                             const PreparedCase& next) {
  const ApproachLibrary::Ways in = library_.ways(object.model, next);
  const Pose2& map_T_object = object.map_T_object;
  if (!in.known ||
      !isFreeLine(map_T_object * in.object_T_predock, map_T_object * next.robot_begin)) {
    return false;
  }
  const Window window = stamp(library_.clearance(object.model), map_T_object);
  const bool connected =
      connects(map_T_robot.position(), (map_T_object * in.object_T_predock).position());
  restore(window);
  return connected;
}

}  // namespace casepush
