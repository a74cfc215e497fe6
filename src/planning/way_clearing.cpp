// What of PushPlanner deals with movable obstacles: who is in the way, and how to push it away.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "casepush/common/input_error.h"
#include "chain_plan.h"
#include "clearing_search.h"
#include "drive_field.h"
#include "planner_data.h"
#include "push_risk.h"
#include "way.h"

namespace casepush {
namespace {

constexpr int kMaxNodes = 1500;     // Of one search: about three pushes deep.
constexpr double kPassing_m = 0.2;  // More than the robot needs to pass is no better.
constexpr double kDocking_m = 0.4;  // Behind a push's start that the robot comes along.
constexpr double kBeside_m = 0.3;   // Clearance around objects is exact up to this.
constexpr double kNoWay_m = 30.0;   // Where cells show no way it counts as this long.
constexpr std::size_t kStride = 4;  // Stations of a way: its poses are half a cell apart.

/// The plan's first pushes; a negative count is all of them.
std::vector<PlannedPush> nextPushes(const PushPlan& plan, int count) {
  const std::size_t all = plan.pushes.size();
  const std::size_t wanted = count < 0 ? all : std::min<std::size_t>(count, all);
  return {plan.pushes.begin(), plan.pushes.begin() + static_cast<std::ptrdiff_t>(wanted)};
}

/// Nearest first.
void sortByDistance(const Pose2& pose, std::vector<PlacedObject>* obstacles) {
  std::stable_sort(obstacles->begin(), obstacles->end(),
                   [&pose](const PlacedObject& a, const PlacedObject& b) {
                     return distance(a.map_T_object, pose) < distance(b.map_T_object, pose);
                   });
}

}  // namespace

std::vector<std::string> PushPlanner::inTheWay(const PushPlan& plan, const std::vector<Case>& cases,
                                               const std::vector<PlacedObject>& obstacles,
                                               int count) const {
  std::vector<PlacedObject> nearest = obstacles;
  sortByDistance(plan.object.map_T_object, &nearest);
  std::vector<std::string> ids;
  if (!checkObstacles(obstacles, data_->objects).empty()) return ids;
  const CollisionChecker checker = data_->checkerWith(placeObstacles(nearest, data_->objects));
  std::vector<bool> is_hit(nearest.size(), false);
  const auto note = [&](const Footprint& footprint, const Pose2& map_T_body) {
    if (!checker.collides(footprint, map_T_body)) return;
    for (const Contact& contact : checker.contacts(footprint, map_T_body)) {
      if (contact.with == Contact::With::kObstacle) is_hit[contact.obstacle] = true;
    }
  };
  const double step_m = kStepPerCell * data_->checker.columns().resolution_m;
  const double radius_m = data_->objects.at(plan.object.model).radius_m;
  const Footprint& object = *data_->footprints.at(plan.object.model).grown;
  for (const PlannedPush& push : nextPushes(plan, count)) {
    const Case* push_case = findCase(cases, push.case_id);
    if (push_case == nullptr) continue;
    const PreparedCase prepared =
        prepareCase(*push_case, plan.zeta, step_m, radius_m, data_->robot.radius_m);
    for (const Pose2& pose : prepared.object_path) note(object, push.map_T_start * pose);
    for (const Pose2& pose : prepared.start_T_sigma) note(object, push.map_T_start * pose);
    note(object, push.map_T_start * prepared.start_outcome.mean);
    for (const Pose2& pose : prepared.robot_path) {
      note(*data_->robot_footprint, push.map_T_start * pose);
    }
  }
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (is_hit[i]) ids.push_back(nearest[i].id);
  }
  return ids;
}

std::vector<std::string> PushPlanner::inTheRobotsWay(const PlacedObject& object,
                                                     const std::vector<PlacedObject>& movable,
                                                     const std::vector<PlacedObject>& standing,
                                                     const Pose2& map_T_robot,
                                                     const Pose2& map_T_goal,
                                                     double dock_direction_rad) const {
  std::vector<PlacedObject> all = standing;
  all.insert(all.end(), movable.begin(), movable.end());
  if (approachPath(object, all, map_T_robot, map_T_goal, dock_direction_rad).found) return {};
  const RobotPath path =
      approachPath(object, standing, map_T_robot, map_T_goal, dock_direction_rad);
  std::vector<std::string> ids;
  if (!path.found) return ids;
  const Shadow outline = outlineOf(data_->robot.solid);
  Way way;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    const Pose2& from = path.waypoints[i - 1];
    const Pose2& to = path.waypoints[i];
    const int steps = 1 + static_cast<int>(distance(from, to) / 0.1);
    for (int k = 0; k <= steps; ++k) {
      way.add(outline, interpolate(from, to, static_cast<double>(k) / steps));
    }
  }
  std::vector<PlacedObject> nearest = movable;
  sortByDistance(map_T_robot, &nearest);
  for (const PlacedObject& obstacle : nearest) {
    const Shadow body = outlineOf(data_->objects.at(obstacle.model).solid);
    const double margin_m = data_->options.robot_path.margin_m;
    if (way.distance(body, obstacle.map_T_object, margin_m) < margin_m) {
      ids.push_back(obstacle.id);
    }
  }
  return ids;
}

namespace {

/// Everything that the plan's object and the robot pushing it will pass over in the next pushes.
void addWay(const PushPlan& plan, int count, const std::vector<Case>& cases,
            const ObjectModel& object, const RobotModel& robot, double step_m, Way* way) {
  const Shadow object_outline = outlineOf(object.solid);
  const Shadow robot_outline = outlineOf(robot.solid);
  for (const PlannedPush& push : nextPushes(plan, count)) {
    const Case* push_case = findCase(cases, push.case_id);
    if (push_case == nullptr) continue;
    const PreparedCase prepared =
        prepareCase(*push_case, plan.zeta, step_m, object.radius_m, robot.radius_m);
    const auto add = [&](const Shadow& outline, const std::vector<Pose2>& path) {
      for (std::size_t i = 0; i < path.size(); i += kStride) {
        way->add(outline, push.map_T_start * path[i]);
      }
      if (!path.empty()) way->add(outline, push.map_T_start * path.back());
    };
    add(object_outline, prepared.object_path);
    add(object_outline, prepared.start_T_sigma);
    add(robot_outline, prepared.robot_path);
    const Pose2 behind(-kDocking_m * std::cos(prepared.push_direction_rad),
                       -kDocking_m * std::sin(prepared.push_direction_rad), 0.0);
    const Pose2& begin = prepared.robot_begin;
    way->add(robot_outline,
             push.map_T_start * Pose2(begin.x() + behind.x(), begin.y() + behind.y(), begin.yaw()));
  }
}

/// What a place out of the way has to be, the best first.
struct ClearingLevel {
  bool all_pushes;  ///< Off all pushes to come, or off the next ones only.
  double needed_m;  ///< Least distance from them: poses are estimates.
  double zeta;      ///< Of the obstacle's pushes.
};
constexpr ClearingLevel kLevels[] = {
    {true, 0.05, 3.0}, {true, 0.05, 1.0},  {false, 0.05, 3.0}, {false, 0.05, 1.0},
    {true, 0.05, 0.0}, {false, 0.05, 0.0}, {false, 0.01, 0.0},
};

/// What an obstacle is to leave free.
struct KeptFree {
  Way all_pushes;
  Way next_pushes;
  Way others;  ///< Where other objects stand.
};

KeptFree keptFree(const ClearingRequest& request, const std::vector<Case>& cases,
                  const ObjectModels& objects, const RobotModel& robot, double step_m) {
  KeptFree free;
  for (const PushPlan& plan : request.ways) {
    const ObjectModel& object = objects.at(plan.object.model);
    addWay(plan, -1, cases, object, robot, step_m, &free.all_pushes);
    addWay(plan, request.next_pushes, cases, object, robot, step_m, &free.next_pushes);
  }
  for (const PlacedObject& other : request.standing) {
    free.others.add(outlineOf(objects.at(other.model).solid), other.map_T_object);
  }
  return free;
}

/// The robot's ways to the obstacle, around it, and from there to where it is needed next.
class Drives {
 public:
  /// @param all  Everything but the obstacle.
  Drives(const ClearanceGrid& map, const ApproachLibrary& robot,
         const std::vector<PlacedSolid>& all, const Solid& obstacle,
         const Eigen::Vector2d& map_next)
      : robot_(robot),
        obstacle_(obstacle),
        grid_(map),
        back_(withAll(all), robot.minClearance(), map_next) {}

  /// @param obstacle  Where it stands meanwhile.
  double length(const Eigen::Vector2d& from, const Pose2& map_T_obstacle,
                const Eigen::Vector2d& to) {
    if (!field_ || from != from_) {
      ClearanceGrid grid = grid_;
      grid.add({obstacle_, map_T_obstacle}, robot_.discs(), kBeside_m);
      from_ = from;
      field_.emplace(std::move(grid), robot_.minClearance(), from);
    }
    return known(field_->lengthTo(to));
  }

  double lengthBack(const Eigen::Vector2d& from) const { return known(back_.lengthTo(from)); }

 private:
  const ClearanceGrid& withAll(const std::vector<PlacedSolid>& all) {
    for (const PlacedSolid& solid : all) grid_.add(solid, robot_.discs(), kBeside_m);
    return grid_;
  }

  // Cells do not show every way; whether there is one is asked elsewhere.
  static double known(double length_m) { return std::min(length_m, kNoWay_m); }

  const ApproachLibrary& robot_;
  const Solid& obstacle_;
  ClearanceGrid grid_;
  DriveField back_;
  std::optional<DriveField> field_;  ///< Of the last place that was asked for.
  Eigen::Vector2d from_;
};

/// Where the robot begins the way's next push; where it stands if that is not known.
Eigen::Vector2d nextPlace(const ClearingRequest& request, const std::vector<Case>& cases) {
  const PushPlan& way = request.ways.back();
  const Case* next = way.pushes.empty() ? nullptr : findCase(cases, way.pushes.front().case_id);
  if (next == nullptr) return request.map_T_robot.position();
  return (way.pushes.front().map_T_start * next->steps.front().start_T_robot()).position();
}

/// The same as one search sees it.
struct Avoided {
  const Way& way;
  const Way& others;
  double needed_m;
};

/// How long the robot takes for a push with its way there; infinity if it does not get there.
double pushTimeS(const ClearingRequest& request, const CaseSet& set, const Pose2& map_T_obstacle,
                 int previous, int next, ApproachVerifier* approaches, Drives* drives) {
  const PreparedCase* before = previous < 0 ? nullptr : &set.cases[previous];
  const PreparedCase& push_case = set.cases[next];
  const bool is_near =
      before != nullptr && approaches->canApproachSimply(map_T_obstacle, before, push_case);
  if (is_near) return set.time.after(previous, next);
  if (!approaches->canApproach(map_T_obstacle, before, push_case)) {
    return std::numeric_limits<double>::infinity();
  }
  const Pose2 map_T_robot =
      before == nullptr ? request.map_T_robot : map_T_obstacle * before->outcome_T_robot;
  const Pose2 begin = map_T_obstacle * push_case.robot_begin;
  return set.time.first(map_T_obstacle.inverse() * map_T_robot, next,
                        drives->length(map_T_robot.position(), map_T_obstacle, begin.position()));
}

ClearingChain clearFrom(const ClearingRequest& request, const SearchProblem& search,
                        const CaseSet& set, const Avoided& avoided, PushChecker* push_checker,
                        ApproachVerifier* approaches, Drives* drives, const SearchClock& clock) {
  const Shadow outline = outlineOf(search.object.solid);
  const double wanted_m = 2.0 * search.robot.radius_m + kPassing_m;
  const ClearingProblem clearing{
      set.cases,
      set.time,
      *push_checker,
      request.obstacle.map_T_object,
      request.map_T_robot,
      search.options.spacing_m,
      search.object.gyration_radius_m,
      kMaxNodes,
      wanted_m,
      avoided.needed_m,
      [&](const Pose2& pose) { return avoided.way.distance(outline, pose, wanted_m); },
      [&](const Pose2& pose) { return avoided.others.distance(outline, pose, wanted_m); },
      [&](const Pose2& pose, int previous, int next) {
        return pushTimeS(request, set, pose, previous, next, approaches, drives);
      },
      [&](const Pose2& robot) { return set.time.driveS(drives->lengthBack(robot.position())); }};
  return searchClearing(clearing, [&clock] { return clock.isOver(); });
}

ClearingResult notCleared(const std::string& why) {
  ClearingResult result;
  result.explanation = why;
  return result;
}

}  // namespace

ClearingResult PushPlanner::clear(const ClearingRequest& request, const std::vector<Case>& cases,
                                  const std::function<bool()>& stop) const {
  const SearchClock clock(request.deadline_s, stop);
  PlanRequest plan_request;
  plan_request.object = request.obstacle;
  plan_request.map_T_goal = request.obstacle.map_T_object;
  plan_request.map_T_robot = request.map_T_robot;
  plan_request.obstacles = request.standing;
  plan_request.deadline_s = request.deadline_s;
  if (const auto problem = checkRequest(plan_request, data_->objects)) {
    return notCleared(problem->explanation);
  }
  std::vector<const Case*> own;
  for (const Case& each : cases) {
    const bool is_whole = each.id >= 0;  // There is no need to be careful with short steps.
    if (is_whole && isFor(each, request.obstacle.model, data_->robot.name)) own.push_back(&each);
  }
  if (own.empty()) return notCleared("there are no cases of " + request.obstacle.model);
  try {
    return data_->clearAway(request, plan_request, own, cases, clock);
  } catch (const InputError& error) {
    return notCleared(error.what());  // A damaged case.
  }
}

ClearingResult PushPlanner::Data::clearAway(const ClearingRequest& request,
                                            const PlanRequest& plan_request,
                                            const std::vector<const Case*>& own,
                                            const std::vector<Case>& cases,
                                            const SearchClock& clock) const {
  const std::vector<PlacedSolid> standing = placeObstacles(request.standing, objects);
  PushChecker push_checker = pushChecker(request.obstacle.model, standing);
  push_checker.tolerateStart(request.obstacle.map_T_object);
  const SearchProblem search = problem(plan_request, own, standing);
  const KeptFree free =
      keptFree(request, cases, objects, robot, kStepPerCell * checker.columns().resolution_m);
  ApproachVerifier approaches_of(search, push_checker.collisions(),
                                 [&clock] { return clock.isOver(); });
  Drives drives(*travel, *approaches, standing, search.object.solid, nextPlace(request, cases));
  ClearingResult result;
  result.explanation = "no push of " + request.obstacle.model +
                       " leads out of the way; clear some space around it by hand";
  for (const ClearingLevel& level : kLevels) {
    const SafetyLevel safety{std::min(level.zeta, options.zeta), {}};
    const auto set = caseSetFor(search, push_checker, safety.zeta, clock);
    if (set == nullptr) return notCleared("no time was left to look for pushes");
    const Way& way = level.all_pushes ? free.all_pushes : free.next_pushes;
    const ClearingChain chain = clearFrom(request, search, *set, {way, free.others, level.needed_m},
                                          &push_checker, &approaches_of, &drives, clock);
    result.nodes += chain.nodes;
    if (chain.found) {
      result.found = true;
      result.off_all_pushes = level.all_pushes;
      result.expected_s = chain.cost_s;
      result.back_s = chain.back_s;
      result.distance_m = chain.distance_m;
      result.plan = planOf(plan_request, set->cases, chain.pushes, safety);
      result.explanation = std::to_string(chain.pushes.size()) + " pushes bring " +
                           request.obstacle.id + " out of the way" +
                           (level.all_pushes ? "" : " of the next pushes");
      return result;
    }
    if (clock.isOver()) return notCleared("no time was left to look for pushes");
  }
  return result;
}

}  // namespace casepush
