#include "checker_data.h"

namespace casepush {

double depthInObstacle(const Footprint& footprint, const Pose2& map_T_solid,
                       const Obstacle& obstacle, const Pose2& map_T_obstacle, std::string* part) {
  double deepest = 0.0;
  for (const ConvexPart& theirs : obstacle.parts) {
    for (const ConvexPart& ours : footprint.parts()) {
      const double depth =
          overlapDepth(ours, map_T_solid, theirs, map_T_obstacle, footprint.margin());
      if (depth <= deepest) continue;
      deepest = depth;
      if (part == nullptr) return deepest;
      *part = theirs.name();
    }
  }
  return deepest;
}

bool CollisionChecker::Data::overlapsObstacle(const Footprint& footprint,
                                              const Pose2& map_T_solid) const {
  for (std::size_t i = 0; i < around->placed.size(); ++i) {
    if (!mayTouch(footprint, map_T_solid, i)) continue;
    if (depthInObstacle(footprint, map_T_solid, around->prepared[i], around->placed[i].map_T_solid,
                        nullptr) > 0.0) {
      return true;
    }
  }
  return false;
}

}  // namespace casepush
