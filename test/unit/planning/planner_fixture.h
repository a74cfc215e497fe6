#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>

#include "casepush/planning/push_planner.h"
#include "planning/furnished_room.h"
#include "planning/synthetic_pushes.h"

namespace casepush {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

inline PushPlannerOptions quick() {
  PushPlannerOptions options;
  options.improvement_extensions = 2000;
  return options;
}

inline std::unique_ptr<PushPlanner> plannerFor(const WorldModel& world,
                                               const PushPlannerOptions& options) {
  return std::make_unique<PushPlanner>(mapOf(world), testRobot(),
                                       std::map<std::string, ObjectModel>{{"chair", testChair()}},
                                       options);
}

inline PlanRequest requestFor(const Pose2& start, const Pose2& goal) {
  PlanRequest request;
  request.object = {"chair_1", "chair", start};
  request.map_T_goal = goal;
  request.map_T_robot = Pose2(6.5, 6.5, 0.0);
  request.deadline_s = 60.0;  // Tests of the deadline set their own.
  return request;
}

inline const Pose2 kStart(3.0, 3.5, 0.3);
inline const Pose2 kGoal(11.5, 7.0, 1.0);

}  // namespace casepush
