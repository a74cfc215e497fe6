#pragma once

#include <memory>
#include <string>
#include <vector>

#include "casepush/world/collision_checker.h"
#include "footprint.h"
#include "map_columns.h"

namespace casepush {

/// An obstacle's parts, ready for pair tests.
struct Obstacle {
  std::vector<ConvexPart> parts;
  double reach_m = 0.0;
};

/// Solids around, shared by copies of a checker.
struct Surroundings {
  std::vector<PlacedSolid> placed;
  std::vector<Obstacle> prepared;
  CollisionChecker::Columns columns;  ///< Of map and solids.
};

/// Deepest overlap of the footprint with a part of the obstacle; `part` names it. Without `part`
/// any overlap will do.
double depthInObstacle(const Footprint& footprint, const Pose2& map_T_solid,
                       const Obstacle& obstacle, const Pose2& map_T_obstacle, std::string* part);

struct CollisionChecker::Data {
  std::shared_ptr<const MapColumns> map;
  std::shared_ptr<const Surroundings> around;

  bool mayReachOut(const Footprint& footprint, const Pose2& pose) const {
    const Eigen::Array2d p = pose.position().array();
    return (p - footprint.reach() < map->min_m.array()).any() ||
           (p + footprint.reach() > map->max_m.array()).any();
  }
  bool mayTouch(const Footprint& footprint, const Pose2& pose, std::size_t obstacle) const {
    const double reach = footprint.reach() + around->prepared[obstacle].reach_m;
    const Eigen::Vector2d offset =
        around->placed[obstacle].map_T_solid.position() - pose.position();
    return offset.squaredNorm() < reach * reach;
  }

  /// Does the footprint overlap any of the obstacles?
  bool overlapsObstacle(const Footprint& footprint, const Pose2& map_T_solid) const;
};

}  // namespace casepush
