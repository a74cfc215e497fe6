// What of PushPlanner deals with movable obstacles: who is in the way, and how to push it away.
#include <algorithm>
#include <cmath>
#include <utility>

#include "chain_plan.h"
#include "clearing_search.h"
#include "planner_data.h"
#include "push_risk.h"
#include "way.h"

namespace casepush {
namespace {

constexpr int kMaxNodes = 4000;
constexpr double kNeeded_m = 0.05;    // Of the obstacle from the way: poses are estimates.
constexpr double kPassing_m = 0.2;    // More than the robot needs to pass is no better.
constexpr double kSightline_m = 3.0;  // Whatever is farther off counts as this far.
constexpr double kDocking_m = 0.4;    // Behind a push's start that the robot comes along.
constexpr std::size_t kStride = 4;    // Stations of a way: its poses are half a cell apart.

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
  const std::size_t pushes =
      count < 0 ? plan.pushes.size() : std::min<std::size_t>(count, plan.pushes.size());
  const double step_m = kStepPerCell * data_->checker.columns().resolution_m;
  PushChecker alone = data_->pushChecker(plan.object.model, {});
  std::vector<std::pair<PreparedCase, Pose2>> safe;  // What hits the map anyway blames nobody.
  for (std::size_t i = 0; i < pushes; ++i) {
    const PlannedPush& push = plan.pushes[i];
    const Case* push_case = findCase(cases, push.case_id);
    if (push_case == nullptr) continue;
    const auto prepared =
        prepareCases({*push_case}, plan.zeta, step_m, data_->objects.at(plan.object.model).radius_m,
                     data_->robot.radius_m);
    if (alone.conflict(prepared.front(), push.map_T_start) == PushConflict::kNone) {
      safe.emplace_back(prepared.front(), push.map_T_start);
    }
  }
  for (const PlacedObject& obstacle : nearest) {
    PushChecker together =
        data_->pushChecker(plan.object.model, placeObstacles({obstacle}, data_->objects));
    const bool is_hit = std::any_of(safe.begin(), safe.end(), [&together](const auto& push) {
      return together.conflict(push.first, push.second) != PushConflict::kNone;
    });
    if (is_hit) ids.push_back(obstacle.id);
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
    if (way.distance(body, obstacle.map_T_object, kSightline_m) <
        data_->options.robot_path.margin_m) {
      ids.push_back(obstacle.id);
    }
  }
  return ids;
}

namespace {

/// Everything that the plan's object and the robot pushing it will pass over.
void addWay(const PushPlan& plan, const std::vector<Case>& cases, const ObjectModel& object,
            const RobotModel& robot, double step_m, Way* way) {
  const Shadow object_outline = outlineOf(object.solid);
  const Shadow robot_outline = outlineOf(robot.solid);
  for (const PlannedPush& push : plan.pushes) {
    const Case* push_case = findCase(cases, push.case_id);
    if (push_case == nullptr) continue;
    const PreparedCase prepared =
        prepareCases({*push_case}, plan.zeta, step_m, object.radius_m, robot.radius_m).front();
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
    if (isFor(each, request.obstacle.model, data_->robot.name)) own.push_back(&each);
  }
  if (own.empty()) return notCleared("there are no cases of " + request.obstacle.model);
  return data_->clearAway(request, plan_request, own, cases, clock);
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
  const ObjectModel& model = search.object;
  const double step_m = kStepPerCell * checker.columns().resolution_m;
  Way way;
  for (const PushPlan& plan : request.ways) {
    addWay(plan, cases, objects.at(plan.object.model), robot, step_m, &way);
  }
  Way others;
  for (const PlacedObject& other : request.standing) {
    others.add(outlineOf(objects.at(other.model).solid), other.map_T_object);
  }
  const Shadow outline = outlineOf(model.solid);
  ApproachVerifier approaches_of(search, push_checker.collisions());
  ClearingResult result;
  result.explanation = "no push of " + request.obstacle.model +
                       " leads out of the way; clear some space around it by hand";
  for (const SafetyLevel& safety : safetyLevels(RiskOptions{}, options.zeta)) {
    const auto set = caseSetFor(search, push_checker, safety.zeta, clock);
    if (set == nullptr) break;
    const ClearingProblem clearing{
        set->cases,
        set->time,
        push_checker,
        request.obstacle.map_T_object,
        request.map_T_robot,
        options.spacing_m,
        model.gyration_radius_m,
        kMaxNodes,
        2.0 * robot.radius_m + kPassing_m,
        kNeeded_m,
        [&](const Pose2& pose) { return way.distance(outline, pose, kSightline_m); },
        [&](const Pose2& pose) { return others.distance(outline, pose, kSightline_m); },
        [&](const Pose2& pose, int previous, int next) {
          const PreparedCase* before = previous < 0 ? nullptr : &set->cases[previous];
          return approaches_of.canApproach(pose, before, set->cases[next]);
        }};
    const ClearingChain chain = searchClearing(clearing, [&clock] { return clock.isOver(); });
    result.nodes += chain.nodes;
    if (!chain.found) {
      if (clock.isOver()) return notCleared("no time was left to look for pushes");
      continue;
    }
    result.found = true;
    result.expected_s = chain.cost_s;
    result.distance_m = chain.distance_m;
    result.plan = planOf(plan_request, set->cases, chain.pushes, safety);
    result.explanation = std::to_string(chain.pushes.size()) + " pushes bring " +
                         request.obstacle.id + " out of the way";
    return result;
  }
  return result;
}

}  // namespace casepush
