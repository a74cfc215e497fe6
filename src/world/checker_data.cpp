#include "checker_data.h"

#include <cmath>
#include <utility>

#include "casepush/common/check.h"

namespace casepush {
namespace {

// Does a part of the footprint overlap the obstacle? Most pairs are found apart by their outlines
// in the map, which are worked out once.
bool overlaps(const ConvexPart& ours, double margin_m, const Pose2& map_T_solid,
              const Eigen::Vector2d& map_centre, const Obstacle& obstacle,
              const Pose2& map_T_obstacle) {
  bool is_placed = false;
  Shadow outline;
  for (std::size_t i = 0; i < obstacle.parts.size(); ++i) {
    const ConvexPart& theirs = obstacle.parts[i];
    if (!ours.touches(theirs.heights().low_m, theirs.heights().high_m)) continue;
    const double discs_m = ours.disc().radius_m + theirs.disc().radius_m + margin_m;
    if ((map_centre - obstacle.map_centres[i]).squaredNorm() > discs_m * discs_m) continue;
    if (!is_placed) outline = transformed(map_T_solid, ours.shadow());
    is_placed = true;
    if (!closerThan(outline, obstacle.map_outlines[i], margin_m)) continue;
    if (overlapDepth(ours, map_T_solid, theirs, map_T_obstacle, margin_m) > 0.0) return true;
  }
  return false;
}

}  // namespace

Surroundings::Surroundings(std::vector<PlacedSolid> solids) : placed(std::move(solids)) {
  for (const PlacedSolid& each : placed) {
    CASEPUSH_CHECK(each.map_T_solid.isFinite(), each.name);
    Obstacle obstacle;
    obstacle.parts = convexParts(each.solid);
    for (const ConvexPart& part : obstacle.parts) {
      obstacle.reach_m = std::max(obstacle.reach_m, part.reach());
      obstacle.map_outlines.push_back(transformed(each.map_T_solid, part.shadow()));
      obstacle.map_centres.push_back(each.map_T_solid * part.disc().centre_m);
    }
    prepared.push_back(std::move(obstacle));
  }
}

const CollisionChecker::Columns& Surroundings::columnsOn(const MapColumns& map) const {
  if (placed.empty()) return map.columns;
  std::call_once(drawn_, [&] {
    columns_ = map.columns;
    for (const PlacedSolid& each : placed) {
      visitCells(each, columns_, [this](std::size_t column, std::uint64_t slices) {
        columns_.bits[column] |= slices;
      });
    }
  });
  return columns_;
}

double depthInObstacle(const Footprint& footprint, const Pose2& map_T_solid,
                       const Obstacle& obstacle, const Pose2& map_T_obstacle, std::string* part) {
  double deepest = 0.0;
  for (const ConvexPart& theirs : obstacle.parts) {
    for (const ConvexPart& ours : footprint.parts()) {
      const double depth =
          overlapDepth(ours, map_T_solid, theirs, map_T_obstacle, footprint.margin());
      if (depth <= deepest) continue;
      deepest = depth;
      *part = theirs.name();
    }
  }
  return deepest;
}

bool CollisionChecker::Data::overlapsObstacle(const Footprint& footprint,
                                              const Pose2& map_T_solid) const {
  const double cosine = std::cos(map_T_solid.yaw());
  const double sine = std::sin(map_T_solid.yaw());
  for (std::size_t i = 0; i < around->placed.size(); ++i) {
    if (!mayTouch(footprint, map_T_solid, i)) continue;
    for (const ConvexPart& part : footprint.parts()) {
      const Eigen::Vector2d& centre = part.disc().centre_m;
      const Eigen::Vector2d map_centre(map_T_solid.x() + cosine * centre.x() - sine * centre.y(),
                                       map_T_solid.y() + sine * centre.x() + cosine * centre.y());
      if (overlaps(part, footprint.margin(), map_T_solid, map_centre, around->prepared[i],
                   around->placed[i].map_T_solid)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace casepush
