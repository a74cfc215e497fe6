#include "casepush/planning/robot_path_planner.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <mutex>
#include <sstream>

#include "casepush/common/input_error.h"
#include "clearance_grid.h"
#include "grid_search.h"
#include "short_way.h"
#include "straight_motion.h"

namespace casepush {
namespace {

constexpr double kMaxDock_m = 1.0;
constexpr double kMaxUndock_m = 1.2;
constexpr double kObstacleRange_m = 0.3;  // Clearance around objects is exact up to this.
constexpr int kUndockDirections = 24;

/// All that one query needs. Grid, footprints and checker outlive it.
struct Query {
  const CollisionChecker& checker;
  const ClearanceGrid& grid;
  const GridSearch& search;
  const Patience& patience;
  const Footprint& plain;    ///< The robot's true shape.
  const Footprint& docking;  ///< Grown by the docking margin.

  /// Where a pose's own clearance counts, or only that of the centre of its cell.
  enum class Clear { kHere, kInCell };

  bool canTravel(const Pose2& pose, Clear clear) const {
    const int cell = grid.cell(pose.position());
    if (!search.isFree(cell)) return false;
    if (clear == Clear::kInCell) return true;
    return grid.clearance(cell) >= (grid.centre(cell) - pose.position()).norm();
  }
};

std::string at(const Pose2& pose) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << "(" << pose.x() << ", " << pose.y() << ")";
  return text.str();
}

RobotPath failure(const std::string& explanation) {
  RobotPath path;
  path.explanation = explanation;
  return path;
}

Pose2 shifted(const Pose2& pose, double direction_rad, double length_m) {
  return {pose.x() + length_m * std::cos(direction_rad),
          pose.y() + length_m * std::sin(direction_rad), pose.yaw()};
}

/// Walks from the goal straight back, against the direction of docking, to poses from which the
/// robot can travel.
class DockLine {
 public:
  DockLine(const Query& query, const Pose2& goal, double direction_rad)
      : query_(query),
        motion_(query.checker, query.docking, {query.checker, query.docking, goal}),
        goal_(goal),
        direction_rad_(direction_rad),
        current_(goal) {}

  /// The next such pose in another cell than the last one, those that are clear themselves first;
  /// nothing if there are no more.
  std::optional<Pose2> next() {
    std::optional<Pose2> pose = nextOf(clear_);
    if (pose || clear_ == Query::Clear::kInCell) return pose;
    clear_ = Query::Clear::kInCell;
    back_m_ = 0.0;
    current_ = goal_;
    return nextOf(clear_);
  }

  bool foundAny() const { return last_cell_ >= 0; }

  std::string explanation() const {
    if (block_) {
      return "no room to dock: the straight way to the dock pose is blocked by " +
             describe(*block_, query_.checker.obstacles());
    }
    return "no room to dock: no free place within 1 m straight behind the dock pose " + at(goal_);
  }

 private:
  std::optional<Pose2> nextOf(Query::Clear clear) {
    const double step_m = query_.grid.resolution() / 2.0;
    while (back_m_ <= kMaxDock_m) {
      const Pose2 pose = shifted(goal_, direction_rad_, -back_m_);
      block_ = motion_.firstBlock(current_, pose);
      if (block_) break;
      current_ = pose;
      back_m_ += step_m;
      const int cell = query_.grid.cell(pose.position());
      if (cell == last_cell_ || !query_.canTravel(pose, clear)) continue;
      last_cell_ = cell;
      return pose;
    }
    return std::nullopt;
  }

  const Query& query_;
  StraightMotion motion_;
  Pose2 goal_;
  double direction_rad_;
  Pose2 current_;
  Query::Clear clear_ = Query::Clear::kHere;
  double back_m_ = 0.0;
  int last_cell_ = -1;
  std::optional<Contact> block_;
};

/// Straight ways out of a place where the robot cannot travel.
class Undocking {
 public:
  Undocking(const Query& query, const Pose2& start) : query_(query), start_(start) {}

  /// Nearest clear pose, in a straight line from the start, in a cell that is marked in `wanted`;
  /// of those equally near the one with most clearance. The motion comes no closer to anything than
  /// the start is: within the docking margin if possible, else where it overlaps.
  std::optional<Pose2> find(const std::vector<std::uint8_t>& wanted) {
    for (const Footprint* footprint : {&query_.docking, &query_.plain}) {
      const StraightMotion motion(query_.checker, *footprint, {query_.checker, *footprint, start_});
      if (const auto pose = find(motion, wanted)) return pose;
    }
    return std::nullopt;
  }

  /// What was in the way first.
  const std::optional<Contact>& block() const { return block_; }

 private:
  std::optional<Pose2> find(const StraightMotion& motion, const std::vector<std::uint8_t>& wanted) {
    const double step_m = query_.grid.resolution() / 2.0;
    std::vector<Pose2> front(kUndockDirections, start_);
    std::vector<std::uint8_t> blocked(kUndockDirections, 0);
    for (double out_m = step_m; out_m <= kMaxUndock_m; out_m += step_m) {
      std::optional<Pose2> best;
      float best_clearance = 0.0F;
      for (int i = 0; i < kUndockDirections; ++i) {
        if (blocked[i]) continue;
        const Pose2 pose = shifted(start_, i * 2.0 * M_PI / kUndockDirections, out_m);
        const auto block = motion.firstBlock(front[i], pose);
        if (!block_) block_ = block;
        blocked[i] = block.has_value();
        front[i] = pose;
        if (blocked[i] || !query_.canTravel(pose, Query::Clear::kHere)) continue;
        const int cell = query_.grid.cell(pose.position());
        if (!wanted[cell] || (best && query_.grid.clearance(cell) <= best_clearance)) continue;
        best = pose;
        best_clearance = query_.grid.clearance(cell);
      }
      if (best) return best;
    }
    return std::nullopt;
  }

  const Query& query_;
  Pose2 start_;
  std::optional<Contact> block_;
};

RobotPath alongWay(std::vector<Pose2> waypoints) {
  RobotPath path;
  path.found = true;
  path.waypoints = std::move(waypoints);
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    path.length_m += distance(path.waypoints[i - 1], path.waypoints[i]);
  }
  return path;
}

/// Undocked, pre-dock and what lies between them.
RobotPath assemble(const Pose2& start, const Pose2& goal,
                   const std::vector<Eigen::Vector2d>& travel) {
  std::vector<Pose2> waypoints{start};
  double travel_m = 0.0;
  for (std::size_t i = 1; i < travel.size(); ++i) travel_m += (travel[i] - travel[i - 1]).norm();
  const auto append = [&waypoints](const Pose2& pose) {
    const Pose2& last = waypoints.back();
    constexpr double kSame = 1e-9;
    if (distance(last, pose) < kSame && std::abs(yawDifference(last, pose)) < kSame) return;
    waypoints.push_back(pose);
  };
  double done_m = 0.0;
  for (std::size_t i = 0; i < travel.size(); ++i) {
    if (i > 0) done_m += (travel[i] - travel[i - 1]).norm();
    const double fraction = travel_m > 0.0 ? std::min(1.0, done_m / travel_m) : 0.0;
    const bool arrived = i + 1 == travel.size();
    const double yaw = arrived ? goal.yaw() : between(start, goal, fraction).yaw();
    append({travel[i].x(), travel[i].y(), yaw});
  }
  append(goal);
  // The goal may be the same up to rounding, yet it is promised exactly.
  if (waypoints.size() == 1) {
    waypoints.push_back(goal);
  } else {
    waypoints.back() = goal;
  }
  return alongWay(std::move(waypoints));
}

/// The robot stands where it can travel.
RobotPath planFromFreeStart(const Query& query, const Pose2& start, const Pose2& goal,
                            double dock_direction_rad) {
  DockLine dock(query, goal, dock_direction_rad);
  const auto reached = query.search.reachable(query.grid.cell(start.position()));
  while (const auto pre_dock = dock.next()) {
    if (!reached[query.grid.cell(pre_dock->position())]) continue;
    return assemble(start, goal, query.search.travel(start.position(), pre_dock->position()));
  }
  if (!dock.foundAny()) return failure(dock.explanation());
  return failure("no free path from " + at(start) + " to the dock pose " + at(goal));
}

/// The robot has to leave something's side first.
RobotPath planFromContact(const Query& query, const Pose2& start, const Pose2& goal,
                          double dock_direction_rad) {
  DockLine dock(query, goal, dock_direction_rad);
  Undocking undocking(query, start);
  std::vector<std::uint8_t> tried(query.grid.size(), 0);
  while (const auto pre_dock = query.patience.isOver() ? std::nullopt : dock.next()) {
    const int cell = query.grid.cell(pre_dock->position());
    if (tried[cell]) continue;
    const auto reached = query.search.reachable(cell);
    if (const auto free = undocking.find(reached)) {
      return assemble(start, goal, query.search.travel(free->position(), pre_dock->position()));
    }
    for (std::size_t i = 0; i < tried.size(); ++i) tried[i] |= reached[i];
  }
  if (!dock.foundAny()) return failure(dock.explanation());
  const std::vector<std::uint8_t> anywhere(query.grid.size(), 1);
  if (undocking.find(anywhere)) {
    return failure("no free path from " + at(start) + " to the dock pose " + at(goal));
  }
  const std::string by = undocking.block() ? describe(*undocking.block(), query.checker.obstacles())
                                           : "what stands around it";
  return failure("start pose blocked by " + by + ": there is no straight way out");
}

void checkOptions(const RobotPathOptions& options) {
  const auto check = [](const char* name, double value, double bound) {
    if (value >= 0.0 && value <= bound) return;
    std::ostringstream what;
    what << "is " << value << ", must be in [0, " << bound << "]";
    throw InputError(std::string("robot path: ") + name, what.str());
  };
  check("margin_m", options.margin_m, 1.0);
  check("dock_margin_m", options.dock_margin_m, 0.5);
  check("contact_tolerance_m", options.contact_tolerance_m, 0.1);
}

}  // namespace

/// What stays the same from query to query on one map.
struct RobotPathPlanner::Cache {
  struct Prepared {
    std::shared_ptr<const CollisionChecker::Columns> columns;
    std::shared_ptr<const ClearanceGrid> grid;
    std::shared_ptr<const Footprint> plain;
    std::shared_ptr<const Footprint> docking;
    std::shared_ptr<const Footprint> travelling;
  };

  explicit Cache(std::vector<TravelDisc> discs_of_robot) : discs(std::move(discs_of_robot)) {}

  /// Without a grid if `patience` was over before that was made.
  Prepared prepare(const CollisionChecker& checker, const Solid& robot,
                   const RobotPathOptions& options, const Patience& patience) {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto columns = checker.mapColumns();
    if (prepared.columns == columns) return prepared;
    auto grid = std::make_shared<ClearanceGrid>(*columns, discs, patience);
    if (patience.isOver()) return {};
    prepared.grid = std::move(grid);
    const bool other_resolution =
        !prepared.columns || prepared.columns->resolution_m != columns->resolution_m;
    if (other_resolution) {
      prepared.plain = checker.footprint(robot);
      prepared.docking = checker.footprint(robot, options.dock_margin_m);
      prepared.travelling = checker.footprint(robot, options.margin_m);
    }
    prepared.columns = columns;
    return prepared;
  }

  void update(const CollisionChecker& before, const CollisionChecker& now,
              const CollisionChecker::Area& changed) {
    const std::lock_guard<std::mutex> lock(mutex);
    const auto columns = now.mapColumns();
    const bool is_of_before = prepared.columns && prepared.columns == before.mapColumns();
    if (!is_of_before || !columns->hasSameExtent(*prepared.columns)) return;
    prepared.grid =
        std::make_shared<ClearanceGrid>(prepared.grid->updated(*columns, discs, changed));
    prepared.columns = columns;
  }

  std::shared_ptr<Cache> copy() {
    auto result = std::make_shared<Cache>(discs);
    const std::lock_guard<std::mutex> lock(mutex);
    result->prepared = prepared;
    return result;
  }

  const std::vector<TravelDisc> discs;
  std::mutex mutex;
  Prepared prepared;
};

RobotPathPlanner::RobotPathPlanner(RobotModel robot, RobotPathOptions options)
    : robot_(std::move(robot)), options_(options) {
  checkOptions(options);
  if (robot_.solid.empty()) throw InputError("robot " + robot_.name, "has no collision shapes");
  cache_ = std::make_shared<Cache>(travelDiscs(robot_.solid, options.margin_m));
}

RobotPathPlanner RobotPathPlanner::updated(const CollisionChecker& before,
                                           const CollisionChecker& now,
                                           const CollisionChecker::Area& changed) const {
  RobotPathPlanner result(*this);
  result.cache_ = cache_->copy();
  result.cache_->update(before, now, changed);
  return result;
}

RobotPath RobotPathPlanner::plan(const CollisionChecker& checker, const Pose2& map_T_robot,
                                 const Pose2& goal, double dock_direction_rad,
                                 const std::function<bool()>& stop) const {
  const Patience patience(stop);
  RobotPath path = planWith(checker, map_T_robot, goal, dock_direction_rad, patience);
  return patience.isOver() ? failure("stopped before a path was found") : path;
}

RobotPath RobotPathPlanner::planWith(const CollisionChecker& checker, const Pose2& map_T_robot,
                                     const Pose2& goal, double dock_direction_rad,
                                     const Patience& patience) const {
  if (!map_T_robot.isFinite()) return failure("start pose is not finite");
  if (!goal.isFinite() || !std::isfinite(dock_direction_rad)) {
    return failure("dock pose or direction is not finite");
  }
  const Cache::Prepared prepared = cache_->prepare(checker, robot_.solid, options_, patience);
  if (prepared.grid == nullptr) return {};
  for (const Contact& contact : checker.contacts(*prepared.plain, goal)) {
    const bool tolerated =
        contact.with == Contact::With::kObstacle && contact.depth_m <= options_.contact_tolerance_m;
    if (!tolerated)
      return failure("dock pose blocked by " + describe(contact, checker.obstacles()));
  }
  if (distance(map_T_robot, goal) < kDirect_m) {
    std::vector<Pose2> way = shortWay(checker, *prepared.docking, *prepared.travelling, map_T_robot,
                                      goal, dock_direction_rad);
    if (!way.empty()) return alongWay(std::move(way));
  }

  ClearanceGrid grid = *prepared.grid;
  for (const PlacedSolid& placed : checker.obstacles()) {
    grid.add(placed, cache_->discs, kObstacleRange_m);
  }
  // Half a diagonal step off a cell's centre the discs without margin must still be free.
  const double half_diagonal_m = grid.resolution() * M_SQRT1_2;
  const GridSearch search(grid, std::max(0.0, half_diagonal_m - options_.margin_m), patience);
  const Query query{checker, grid, search, patience, *prepared.plain, *prepared.docking};
  if (!query.canTravel(map_T_robot, Query::Clear::kHere)) {
    RobotPath path = planFromContact(query, map_T_robot, goal, dock_direction_rad);
    if (path.found || !query.canTravel(map_T_robot, Query::Clear::kInCell)) return path;
  }
  return planFromFreeStart(query, map_T_robot, goal, dock_direction_rad);
}

}  // namespace casepush
