#pragma once

#include <string>
#include <vector>

#include "casepush/model/push_plan.h"

namespace casepush {

/// Asks how to push an object out of the way of others.
struct ClearingRequest {
  PlacedObject obstacle;
  /// Plans whose ways it is to leave: their objects and the robot pushing them, at all pushes.
  std::vector<PushPlan> ways;
  /// If no place off all pushes is found: so many of the next ones of each plan.
  int next_pushes = 3;
  std::vector<PlacedObject> standing;  ///< All else that is known; it stands still.
  Pose2 map_T_robot;
  double deadline_s = 2.0;  ///< Wall time.
};

struct ClearingResult {
  bool found = false;
  std::string explanation;      ///< One line for a person, also if found.
  PushPlan plan;                ///< Of the obstacle.
  double expected_s = 0.0;      ///< Of all its pushes, with the robot's ways to and between them.
  double back_s = 0.0;          ///< Of the robot's way from there to the last plan's next push.
  bool off_all_pushes = false;  ///< Or else off the next ones only.
  double distance_m = 0.0;      ///< Of the obstacle from the ways and from what stands, afterwards.
  int nodes = 0;
};

}  // namespace casepush
