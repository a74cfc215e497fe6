#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/object_model.h"
#include "casepush/model/push_plan.h"
#include "casepush/world/collision_checker.h"

namespace casepush {

using ObjectModels = std::map<std::string, ObjectModel>;

/// Why something cannot be planned, as a status and a line for a person.
struct PlanProblem {
  PlanStatus status = PlanStatus::kInvalidRequest;
  std::string explanation;
};

/// Checks what can be seen without a map: numbers, names, tolerance.
std::optional<PlanProblem> checkRequest(const PlanRequest& request, const ObjectModels& objects);

/// Why the obstacles cannot be placed; empty if they can.
std::string checkObstacles(const std::vector<PlacedObject>& obstacles, const ObjectModels& objects);

/// @pre checkObstacles returned nothing.
std::vector<PlacedSolid> placeObstacles(const std::vector<PlacedObject>& obstacles,
                                        const ObjectModels& objects);

/// Whether the object fits where it stands and where it should go.
///
/// At the start it may overlap something by a cell: poses are estimates and cells are coarse, and
/// an object at a wall must be able to get away from it.
std::optional<PlanProblem> checkStartAndGoal(const PlanRequest& request,
                                             const CollisionChecker& checker,
                                             const Footprint& footprint);

/// Does the object overlap nothing by more than a cell, and is it within the map?
bool mayStart(const std::vector<Contact>& contacts, const CollisionChecker& checker);

/// "(1.23, -0.50, 90 deg)"
std::string describe(const Pose2& pose);
/// With so many digits after the point.
std::string rounded(double value, int digits);

}  // namespace casepush
