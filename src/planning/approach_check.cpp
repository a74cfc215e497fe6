#include "approach_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "casepush/world/shadow.h"
#include "straight_motion.h"

namespace casepush {
namespace {

constexpr double kNode_m = 0.02;      // Spacing of a table's nodes.
constexpr double kRange_m = 0.3;      // Clearance is exact up to this.
constexpr double kOpenHalf_m = 5.0;   // Of the square without anything else.
constexpr double kWayStep_m = 0.025;  // Between ends of a straight way.
constexpr double kLongest_m = 1.2;    // Of a straight way in or out.
constexpr int kDirections = 24;       // Of ways out.
constexpr std::size_t kEnoughEnds = 2;
constexpr int kMostLines = 12;  // Straight ways to be tested for one end of an approach.
constexpr int kNearby = 4000;   // Cells to look at for a way around the object.

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

// What is reached from one end of a way is reached from others near it, mostly.
bool isApart(const std::vector<Eigen::Vector2d>& ends, const Eigen::Vector2d& end) {
  constexpr double kApart_m = 0.4;
  return std::none_of(ends.begin(), ends.end(), [&end](const Eigen::Vector2d& other) {
    return (other - end).norm() < kApart_m;
  });
}

Pose2 shifted(const Pose2& pose, double direction_rad, double length_m) {
  return {pose.x() + length_m * std::cos(direction_rad),
          pose.y() + length_m * std::sin(direction_rad), pose.yaw()};
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
      plain_(map.footprint(robot.solid)),
      open_(openMap(map.columns().resolution_m)),
      min_clearance_m_(std::max(0.0, grid_.resolution() * M_SQRT1_2 - options.margin_m)) {}

const ObjectClearance& ApproachLibrary::clearance(const std::string& model) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<ObjectClearance>& entry = clearances_[model];
  if (!entry) entry = std::make_unique<ObjectClearance>(objects_.at(model).solid, discs_);
  return *entry;
}

std::shared_ptr<const ApproachLibrary::Ways> ApproachLibrary::ways(const std::string& model,
                                                                   const PreparedCase& push_case) {
  const std::string key = keyOf(model, push_case);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = ways_.find(key);
    if (found != ways_.end()) return found->second;
  }
  auto made = std::make_shared<const Ways>(findWays(model, push_case));
  const std::lock_guard<std::mutex> lock(mutex_);
  return ways_.emplace(key, std::move(made)).first->second;
}

std::unique_ptr<ApproachLibrary::Flood> ApproachLibrary::borrowFlood() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (floods_.empty()) {
    auto flood = std::make_unique<Flood>();
    flood->visited.assign(grid_.size(), 0);
    return flood;
  }
  std::unique_ptr<Flood> flood = std::move(floods_.back());
  floods_.pop_back();
  return flood;
}

void ApproachLibrary::giveBack(std::unique_ptr<Flood> flood) {
  const std::lock_guard<std::mutex> lock(mutex_);
  floods_.push_back(std::move(flood));
}

// With the motions that the path planner makes, so that the two agree.
ApproachLibrary::Ways ApproachLibrary::findWays(const std::string& model,
                                                const PreparedCase& push_case) {
  Ways ways;
  CollisionChecker checker = open_;
  checker.setObstacles({{objects_.at(model).solid, Pose2()}});
  const ObjectClearance& clear = clearance(model);
  waysOut(checker, push_case.outcome_T_robot, [&](const Pose2& end) {
    if (clear.at(end.position()) >= 0.0F) ways.object_T_undocked.push_back(end);
    return true;
  });
  const Pose2& docked = push_case.robot_begin;
  const StraightMotion motion(checker, *docking_, {checker, *docking_, docked});
  Pose2 last = docked;
  for (double back_m = 0.0; back_m <= kLongest_m; back_m += kWayStep_m) {
    const Pose2 pose = shifted(docked, push_case.push_direction_rad, -back_m);
    if (motion.firstBlock(last, pose)) break;
    last = pose;
    if (clear.at(pose.position()) >= 0.0F) ways.object_T_predock.push_back(pose);
  }
  return ways;
}

void ApproachLibrary::waysOut(const CollisionChecker& checker, const Pose2& start,
                              const std::function<bool(const Pose2&)>& visit) const {
  bool is_any = false;
  std::vector<Pose2> front(kDirections, start);
  std::vector<bool> blocked(kDirections, false);
  for (const auto& footprint : {docking_, plain_}) {
    const StraightMotion motion(checker, *footprint, {checker, *footprint, start});
    std::fill(front.begin(), front.end(), start);
    std::fill(blocked.begin(), blocked.end(), false);
    for (double out_m = kWayStep_m; out_m <= kLongest_m; out_m += kWayStep_m) {
      for (int i = 0; i < kDirections; ++i) {
        if (blocked[i]) continue;
        const Pose2 pose = shifted(start, 2.0 * M_PI * i / kDirections, out_m);
        blocked[i] = motion.firstBlock(front[i], pose).has_value();
        front[i] = pose;
        if (blocked[i]) continue;
        is_any = true;
        if (!visit(pose)) return;
      }
    }
    if (is_any) return;  // The robot need not come closer to anything than it stands.
  }
}

bool ApproachLibrary::isDirect(const std::string& model, const PreparedCase& previous,
                               const PreparedCase& next) {
  if (distance(previous.outcome_T_robot, next.robot_begin) >= RobotPathPlanner::kDirect_m) {
    return false;
  }
  const std::string key = keyOf(model, previous) + keyOf("", next);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = direct_.find(key);
    if (found != direct_.end()) return found->second;
  }
  CollisionChecker checker = open_;
  checker.setObstacles({{objects_.at(model).solid, Pose2()}});
  const Pose2& from = previous.outcome_T_robot;
  const StraightMotion motion(checker, *docking_, {checker, *docking_, next.robot_begin});
  const bool is_direct =
      !checker.collides(*docking_, from) && !motion.firstBlock(from, next.robot_begin);
  const std::lock_guard<std::mutex> lock(mutex_);
  return direct_.emplace(key, is_direct).first->second;
}

ApproachCheck::ApproachCheck(ApproachLibrary* library, const CollisionChecker& checker,
                             const std::vector<PlacedObject>& obstacles)
    : library_(*library), checker_(checker), flood_(library->borrowFlood()) {
  for (const PlacedObject& obstacle : obstacles) {
    obstacles_.push_back(standing(library_.clearance(obstacle.model), obstacle.map_T_object));
  }
}

ApproachCheck::~ApproachCheck() { library_.giveBack(std::move(flood_)); }

ApproachCheck::Standing ApproachCheck::standing(const ObjectClearance& clearance,
                                                const Pose2& map_T_object) {
  return {&clearance, map_T_object, std::cos(map_T_object.yaw()), std::sin(map_T_object.yaw())};
}

float ApproachCheck::Standing::at(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d away = point_m - map_T_object.position();
  const double reach_m = clearance->reach();
  if (std::abs(away.x()) > reach_m || std::abs(away.y()) > reach_m) {
    return std::numeric_limits<float>::infinity();
  }
  return clearance->at({cosine * away.x() + sine * away.y(), cosine * away.y() - sine * away.x()});
}

float ApproachCheck::clearanceAround(int cell) const {
  float clear_m = library_.grid().clearance(cell);
  const Eigen::Vector2d centre = library_.grid().centre(cell);
  for (const Standing& obstacle : obstacles_) clear_m = std::min(clear_m, obstacle.at(centre));
  return clear_m;
}

float ApproachCheck::clearanceAt(int cell) const {
  return std::min(clearanceAround(cell), object_->at(library_.grid().centre(cell)));
}

bool ApproachCheck::isFreeLine(const Pose2& from, const Pose2& to) const {
  constexpr double kStep_m = 0.01;
  const int steps = std::max(1, static_cast<int>(std::ceil(distance(from, to) / kStep_m)));
  const ClearanceGrid& grid = library_.grid();
  const double half_diagonal_m = grid.resolution() * M_SQRT1_2;
  for (int i = 0; i <= steps; ++i) {
    const Pose2 pose = between(from, to, static_cast<double>(i) / steps);
    const int cell = grid.cell(pose.position());
    // Free whichever way the robot faces. The object itself was looked at on the open floor.
    if (cell >= 0 && clearanceAround(cell) >= half_diagonal_m) continue;
    if (checker_.collides(library_.docking(), pose)) return false;
  }
  return true;
}

bool ApproachCheck::canTravelAt(const Eigen::Vector2d& point) const {
  const int cell = library_.grid().cell(point);
  if (cell < 0) return false;
  const double needed_m =
      std::max(library_.minClearance(), (library_.grid().centre(cell) - point).norm());
  return clearanceAt(cell) >= needed_m;
}

// From both ends at once, each best first, until they meet or one of them has nothing left: the
// smaller of two separate places decides soon.
bool ApproachCheck::connects(const Ends& from, const Ends& to, int most_cells) {
  if (from.empty() || to.empty()) return false;
  ApproachLibrary::Flood& flood = *flood_;
  Front ahead{++flood.round, flood.round + 1, to.front(), flood.ahead};
  Front back{++flood.round, flood.round - 1, from.front(), flood.back};
  bool met = begin(from, ahead);
  met = begin(to, back) || met;
  for (int looked = 0; !met && looked < most_cells; ++looked) {
    Front& front = looked % 2 == 0 ? ahead : back;
    if (front.open.empty()) return false;
    met = advance(front);
  }
  return met;
}

bool ApproachCheck::begin(const Ends& ends, Front& front) {
  front.open.clear();
  bool met = false;
  for (const Eigen::Vector2d& end : ends) met = visit(library_.grid().cell(end), front) || met;
  return met;
}

bool ApproachCheck::advance(Front& front) {
  const ClearanceGrid& grid = library_.grid();
  std::pop_heap(front.open.begin(), front.open.end(), std::greater<>());
  const int cell = front.open.back().second;
  front.open.pop_back();
  const int x = cell % grid.width();
  const int y = cell / grid.width();
  bool met = false;
  for (int dy = y > 0 ? -1 : 0; dy <= (y + 1 < grid.height() ? 1 : 0); ++dy) {
    for (int dx = x > 0 ? -1 : 0; dx <= (x + 1 < grid.width() ? 1 : 0); ++dx) {
      met = visit(cell + dy * grid.width() + dx, front) || met;
    }
  }
  return met;
}

// True if the other front has been there.
bool ApproachCheck::visit(int cell, Front& front) {
  std::uint32_t& visited = flood_->visited[cell];
  if (visited == front.round) return false;
  if (clearanceAt(cell) < static_cast<float>(library_.minClearance())) return false;
  if (visited == front.other_round) return true;
  visited = front.round;
  front.open.emplace_back((library_.grid().centre(cell) - front.towards).squaredNorm(), cell);
  std::push_heap(front.open.begin(), front.open.end(), std::greater<>());
  return false;
}

ApproachCheck::Ends ApproachCheck::freeEnds(const Pose2& map_T_object, const Pose2& docked,
                                            const std::vector<Pose2>& ends) const {
  const Pose2 from = map_T_object * docked;
  Ends found;
  int lines = 0;
  for (const Pose2& object_T_end : ends) {
    const Pose2 end = map_T_object * object_T_end;
    if (!isApart(found, end.position()) || !canTravelAt(end.position())) continue;
    if (isFreeLine(from, end)) found.push_back(end.position());
    if (++lines >= kMostLines || found.size() >= kEnoughEnds) break;
  }
  return found;
}

bool ApproachCheck::canFollow(const PlacedObject& object, const PreparedCase& previous,
                              const PreparedCase& next) {
  const Pose2& map_T_object = object.map_T_object;
  if (library_.isDirect(object.model, previous, next) &&
      isFreeLine(map_T_object * previous.outcome_T_robot, map_T_object * next.robot_begin)) {
    return true;
  }
  object_ = standing(library_.clearance(object.model), map_T_object);
  const auto in = library_.ways(object.model, next);
  const auto to = freeEnds(map_T_object, next.robot_begin, in->object_T_predock);
  if (to.empty()) return false;
  const auto out = library_.ways(object.model, previous);
  const auto from = freeEnds(map_T_object, previous.outcome_T_robot, out->object_T_undocked);
  return connects(from, to, kNearby);
}

bool ApproachCheck::canReach(const PlacedObject& object, const Pose2& map_T_robot,
                             const PreparedCase& next) {
  object_ = standing(library_.clearance(object.model), object.map_T_object);
  const auto in = library_.ways(object.model, next);
  const auto to = freeEnds(object.map_T_object, next.robot_begin, in->object_T_predock);
  return !to.empty() && connects(waysFrom(object, map_T_robot), to, library_.grid().size());
}

// Where the robot gets straight from where it stands, e.g. at the object's side.
const ApproachCheck::Ends& ApproachCheck::waysFrom(const PlacedObject& object,
                                                   const Pose2& map_T_robot) {
  const auto same = [](const Pose2& a, const Pose2& b) {
    return a.x() == b.x() && a.y() == b.y() && a.yaw() == b.yaw();
  };
  if (begun_ && same(begun_->first, map_T_robot) && same(begun_->second, object.map_T_object)) {
    return begun_ends_;
  }
  begun_.emplace(map_T_robot, object.map_T_object);
  begun_ends_.clear();
  if (canTravelAt(map_T_robot.position())) {
    begun_ends_.push_back(map_T_robot.position());
    return begun_ends_;
  }
  CollisionChecker checker = checker_;
  std::vector<PlacedSolid> all = checker_.obstacles();
  all.push_back({library_.solid(object.model), object.map_T_object});
  checker.setObstacles(std::move(all));
  library_.waysOut(checker, map_T_robot, [this](const Pose2& end) {
    const bool is_new = isApart(begun_ends_, end.position());
    if (is_new && canTravelAt(end.position())) begun_ends_.push_back(end.position());
    return begun_ends_.size() < kEnoughEnds;
  });
  return begun_ends_;
}

}  // namespace casepush
