#include "plan_request.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace casepush {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::string quoted(const std::string& name) { return "\"" + name + "\""; }

std::string unknownModel(const PlacedObject& object, const ObjectModels& objects) {
  std::string known;
  for (const auto& [name, model] : objects) {
    known += (known.empty() ? "" : ", ") + name;
  }
  return "object " + quoted(object.id) + ": unknown model " + quoted(object.model) +
         "; known are: " + (known.empty() ? "none" : known);
}

std::string numberProblem(const PlanRequest& request) {
  const GoalTolerance& tolerance = request.tolerance;
  if (!request.object.map_T_object.isFinite()) {
    return "object " + quoted(request.object.id) + ": its pose is not finite";
  }
  if (!request.map_T_goal.isFinite()) {
    return "goal: its pose is not finite";
  }
  if (!request.map_T_robot.isFinite()) {
    return "robot: its pose is not finite";
  }
  if (!(tolerance.position_m > 0.0) || !std::isfinite(tolerance.position_m)) {
    return "tolerance.position_m: is " + std::to_string(tolerance.position_m) +
           ", must be positive and finite";
  }
  if (!(tolerance.yaw_rad > 0.0 && tolerance.yaw_rad <= kPi + 1e-9)) {
    return "tolerance.yaw_rad: is " + std::to_string(tolerance.yaw_rad) + ", must be in (0, pi]";
  }
  if (!(request.deadline_s > 0.0)) {
    return "deadline_s: is " + std::to_string(request.deadline_s) + ", must be positive";
  }
  return {};
}

// Deepest of the contacts; @pre there is one.
const Contact& deepest(const std::vector<Contact>& contacts) {
  return *std::max_element(
      contacts.begin(), contacts.end(),
      [](const Contact& a, const Contact& b) { return a.depth_m < b.depth_m; });
}

}  // namespace

std::string rounded(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

std::string describe(const Pose2& pose) {
  // Whatever is out there: with all digits it would fill a line.
  const bool is_far = std::max(std::abs(pose.x()), std::abs(pose.y())) >= 1e6;
  char text[64];
  std::snprintf(text, sizeof(text), is_far ? "(%.3g, %.3g, %.0f deg)" : "(%.2f, %.2f, %.0f deg)",
                pose.x(), pose.y(), pose.yaw() * 180.0 / kPi);
  return text;
}

std::string checkObstacles(const std::vector<PlacedObject>& obstacles,
                           const ObjectModels& objects) {
  for (const PlacedObject& obstacle : obstacles) {
    if (objects.count(obstacle.model) == 0) {
      return unknownModel(obstacle, objects);
    }
    if (!obstacle.map_T_object.isFinite()) {
      return "object " + quoted(obstacle.id) + ": its pose is not finite";
    }
  }
  return {};
}

std::optional<PlanProblem> checkRequest(const PlanRequest& request, const ObjectModels& objects) {
  if (objects.count(request.object.model) == 0) {
    return PlanProblem{PlanStatus::kInvalidRequest, unknownModel(request.object, objects)};
  }
  if (const std::string problem = numberProblem(request); !problem.empty()) {
    return PlanProblem{PlanStatus::kInvalidRequest, problem};
  }
  if (const std::string problem = checkObstacles(request.obstacles, objects); !problem.empty()) {
    return PlanProblem{PlanStatus::kInvalidRequest, problem};
  }
  for (const PlacedObject& obstacle : request.obstacles) {
    if (obstacle.id == request.object.id) {
      return PlanProblem{PlanStatus::kInvalidRequest,
                         "object " + quoted(obstacle.id) + ": is its own obstacle"};
    }
  }
  return std::nullopt;
}

std::vector<PlacedSolid> placeObstacles(const std::vector<PlacedObject>& obstacles,
                                        const ObjectModels& objects) {
  std::vector<PlacedSolid> placed;
  placed.reserve(obstacles.size());
  for (const PlacedObject& obstacle : obstacles) {
    placed.push_back({objects.at(obstacle.model).solid, obstacle.map_T_object, obstacle.id});
  }
  return placed;
}

bool mayStart(const std::vector<Contact>& contacts, const CollisionChecker& checker) {
  return std::all_of(contacts.begin(), contacts.end(), [&checker](const Contact& contact) {
    return contact.with != Contact::With::kOutside &&
           contact.depth_m <= checker.columns().resolution_m;
  });
}

std::optional<PlanProblem> checkStartAndGoal(const PlanRequest& request,
                                             const CollisionChecker& checker,
                                             const Footprint& footprint) {
  const Pose2& start = request.object.map_T_object;
  const Pose2& goal = request.map_T_goal;
  const auto name = [&] {
    return "object " + quoted(request.object.id) + " at " + describe(start);
  };
  if (!checker.isInside(goal)) {
    return PlanProblem{PlanStatus::kGoalOutsideMap,
                       "goal " + describe(goal) + ": lies outside of the map"};
  }
  if (!checker.isInside(start)) {
    return PlanProblem{PlanStatus::kStartInCollision, name() + ": stands outside of the map"};
  }
  const std::vector<Contact> at_start = checker.contacts(footprint, start);
  if (!mayStart(at_start, checker)) {
    return PlanProblem{PlanStatus::kStartInCollision,
                       name() + ": overlaps " + describe(deepest(at_start), checker.obstacles())};
  }
  const std::vector<Contact> at_goal = checker.contacts(footprint, goal);
  if (!at_goal.empty()) {
    return PlanProblem{PlanStatus::kGoalInCollision,
                       "goal " + describe(goal) + ": the object would overlap " +
                           describe(deepest(at_goal), checker.obstacles())};
  }
  return std::nullopt;
}

}  // namespace casepush
