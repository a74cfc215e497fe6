#include "casepush/execution/push_ground.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>
#include <utility>

#include "coverage.h"

namespace casepush {
namespace {

// Besides the robot's width, between the object and what stands around.
constexpr double kSlackM = 0.25;
// Kept from everything during a push.
constexpr double kMarginM = 0.06;
// Below it, what was tracked may have been a touch.
constexpr double kTouchM = 0.0;
constexpr double kSigmas = 2.0;
// Beyond what the robot needs: so much lets it push freely.
constexpr double kPlentyM = 1.2;
constexpr double kSearchStepM = 0.1;
constexpr double kSearchRadiusM = 8.0;

}  // namespace

PushCourse courseOf(const Case& push_case) {
  PushCourse course;
  for (const CaseStep& step : push_case.steps) {
    course.start_T_object.push_back(step.start_T_object);
    course.start_T_robot.push_back(step.start_T_robot());
  }
  course.start_outcome = push_case.start_outcome;
  return course;
}

PushGround::PushGround(const CollisionChecker& checker, const ObjectModel& object,
                       const RobotModel& robot, const Eigen::Vector2d& map_start_m)
    : clearance_(checker.columns()),
      object_radius_m_(object.radius_m),
      robot_radius_m_(robot.radius_m),
      needed_m_(2.0 * robot.radius_m + kSlackM),
      middle_m_(findMiddle(map_start_m)) {}

double PushGround::objectRoom(const Pose2& map_T_object) const {
  return clearance_.at(map_T_object.position()) - object_radius_m_;
}

double PushGround::robotRoom(const Pose2& map_T_robot) const {
  return clearance_.at(map_T_robot.position()) - robot_radius_m_;
}

Eigen::Vector2d PushGround::findMiddle(const Eigen::Vector2d& start_m) const {
  using Cell = std::pair<int, int>;
  const double plenty_m = object_radius_m_ + needed_m_ + kPlentyM;
  const double passable_m = std::min<double>(object_radius_m_, clearance_.at(start_m));
  const int reach = static_cast<int>(kSearchRadiusM / kSearchStepM);
  std::queue<Cell> open{{{0, 0}}};
  std::set<Cell> seen{{0, 0}};
  Eigen::Vector2d best = start_m;
  double best_m = -1.0;
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop();
    const Eigen::Vector2d point = start_m + kSearchStepM * Eigen::Vector2d(x, y);
    const double clear_m = clearance_.at(point);
    if (clear_m > best_m) {
      best = point;
      best_m = clear_m;
    }
    if (best_m >= plenty_m) {
      break;
    }
    for (const Cell& next : {Cell{x + 1, y}, Cell{x - 1, y}, Cell{x, y + 1}, Cell{x, y - 1}}) {
      const Eigen::Vector2d at = start_m + kSearchStepM * Eigen::Vector2d(next.first, next.second);
      const bool in_reach = std::max(std::abs(next.first), std::abs(next.second)) <= reach;
      if (in_reach && clearance_.at(at) >= passable_m && seen.insert(next).second) {
        open.push(next);
      }
    }
  }
  return best;
}

bool PushGround::isFree(const Pose2& map_T_start, const PushCourse& course, double object_margin_m,
                        double robot_margin_m) const {
  const auto object_free = [&](const Pose2& pose) {
    return objectRoom(map_T_start * pose) > object_margin_m;
  };
  const auto robot_free = [&](const Pose2& pose) {
    return robotRoom(map_T_start * pose) > robot_margin_m;
  };
  return std::all_of(course.start_T_object.begin(), course.start_T_object.end(), object_free) &&
         std::all_of(course.start_T_robot.begin(), course.start_T_robot.end(), robot_free);
}

std::optional<double> PushGround::roomAfter(const Pose2& map_T_object,
                                            const PushCourse& course) const {
  // An object that stands at a wall already may be pushed along it or away from it.
  const double margin_m = std::min(kMarginM, objectRoom(map_T_object) - 1e-3);
  if (!isFree(map_T_object, course, margin_m, kMarginM)) {
    return std::nullopt;
  }
  const double sigma_m = outcomeSigma(course.start_outcome, 1e9).position_m;
  const double room_m = objectRoom(map_T_object * course.start_outcome.mean) - kSigmas * sigma_m;
  return room_m > margin_m ? std::optional<double>(room_m) : std::nullopt;
}

bool PushGround::wasFree(const Pose2& map_T_start, const PushCourse& course) const {
  return isFree(map_T_start, course, kTouchM, kTouchM);
}

}  // namespace casepush
