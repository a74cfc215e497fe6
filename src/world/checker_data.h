#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "casepush/world/collision_checker.h"
#include "footprint.h"
#include "map_columns.h"

namespace casepush {

/// An obstacle's parts, ready for pair tests.
struct Obstacle {
  std::vector<ConvexPart> parts;
  std::vector<Shadow> map_outlines;          ///< Of each part, and
  std::vector<Eigen::Vector2d> map_centres;  ///< of the disc around it.
  double reach_m = 0.0;
};

/// Solids around, shared by copies of a checker.
class Surroundings {
 public:
  explicit Surroundings(std::vector<PlacedSolid> solids);

  const std::vector<PlacedSolid> placed;
  std::vector<Obstacle> prepared;

  /// Of the map and these solids; drawn when first asked for, always with the same map.
  const CollisionChecker::Columns& columnsOn(const MapColumns& map) const;

 private:
  mutable std::once_flag drawn_;
  mutable CollisionChecker::Columns columns_;
};

/// Deepest overlap of the footprint with a part of the obstacle; `part` names it.
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
