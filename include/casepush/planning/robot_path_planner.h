#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "casepush/model/robot_model.h"
#include "casepush/world/collision_checker.h"

namespace casepush {

class Patience;

struct RobotPathOptions {
  double margin_m = 0.04;       ///< Kept from everything while driving freely.
  double dock_margin_m = 0.01;  ///< Kept while docking at an object's side.
  double contact_tolerance_m =
      0.01;  ///< The goal pose may overlap a movable object this deep: poses
             ///< are estimates, and pushes start at the object's side.
};

struct RobotPath {
  bool found = false;
  std::string explanation;       ///< Why not, for a person.
  std::vector<Pose2> waypoints;  ///< In the map, from the robot's pose to the goal, inclusive.
  double length_m = 0.0;
};

/// Finds paths of the robot among the map and objects at their true 3-D shape.
///
/// The robot is round from above at each height while it travels (omnidirectional), so that the
/// heading does not matter; leaving an object's side (undocking) and reaching the next push's start
/// (docking) are straight motions checked with its true shape, with fixed headings. Between
/// waypoints the robot moves straight and turns evenly; it turns to the goal's heading while
/// travelling.
///
/// Grid A* on the map's cells with line-of-sight shortcuts, preferring some clearance;
/// deterministic. The margin is kept at the centres of the cells that are passed; nothing is
/// touched in between. Thread safety: plan() is reentrant. Copies share a cache of the last map's
/// clearance.
class RobotPathPlanner {
 public:
  /// The straight motion is tried first if the goal is this near.
  static constexpr double kDirect_m = 0.5;

  RobotPathPlanner(RobotModel robot, RobotPathOptions options);

  /// One with a cache of its own, which takes over what it can from the map of `before`.
  /// @pre `now` is `before.updated(map, changed)`.
  RobotPathPlanner updated(const CollisionChecker& before, const CollisionChecker& now,
                           const CollisionChecker::Area& changed) const;

  /// @param checker  With every object that stands in the way set as an obstacle, also the one to
  /// be
  ///   pushed next.
  /// @param dock_direction_rad  Heading in the map of the straight motion that ends in `goal`
  ///   (the direction of the push).
  /// @param stop  Asked often; once it says true, no path is found.
  RobotPath plan(const CollisionChecker& checker, const Pose2& map_T_robot, const Pose2& goal,
                 double dock_direction_rad, const std::function<bool()>& stop = {}) const;

 private:
  struct Cache;

  RobotPath planWith(const CollisionChecker& checker, const Pose2& map_T_robot, const Pose2& goal,
                     double dock_direction_rad, const Patience& patience) const;

  RobotModel robot_;
  RobotPathOptions options_;
  std::shared_ptr<Cache> cache_;
};

}  // namespace casepush
