#include "placed_footprint.h"

#include <algorithm>
#include <cmath>

#include "slab.h"

namespace casepush {

namespace {

double depthInCells(const Shadow& square, const ConvexPart& part, double margin_m, double low_m,
                    double high_m) {
  if (!part.touches(low_m, high_m)) return 0.0;
  if (!closerThan(part.shadow(), square, margin_m - kContactTolerance_m)) return 0.0;
  if (part.isPrism()) return margin_m - separation(part.shadow(), square);
  const Shadow between = part.shadow(low_m, high_m);
  return between.empty() ? 0.0 : margin_m - separation(between, square);
}

}  // namespace

bool partReachesInto(const Footprint& footprint, std::size_t index, const Shadow& square,
                     const MapColumns& map, std::size_t column) {
  const double resolution_m = map.columns.resolution_m;
  const Eigen::Vector2d centre = (square.points[0] + square.points[2]) / 2.0;
  const BoundingDisc& disc = footprint.discs()[index];
  const double discs_m = disc.radius_m + resolution_m * M_SQRT1_2;
  if ((disc.centre_m - centre).squaredNorm() > discs_m * discs_m) return false;
  const ConvexPart& part = footprint.parts()[index];
  const double limit_m = footprint.margin() - kContactTolerance_m;
  for (std::uint32_t run = map.first_run[column]; run < map.first_run[column + 1]; ++run) {
    const double low_m = map.runs[run].low * resolution_m;
    const double high_m = map.runs[run].high * resolution_m;
    if (!part.touches(low_m, high_m)) continue;
    if (!closerThan(part.shadow(), square, limit_m)) return false;
    if (part.isPrism()) return true;
    const Shadow between = part.shadow(low_m, high_m);
    if (!between.empty() && closerThan(between, square, limit_m)) return true;
  }
  return false;
}

double depthInColumn(const Footprint& footprint, const Shadow& square, const MapColumns& map,
                     std::size_t column) {
  const double resolution_m = map.columns.resolution_m;
  const Eigen::Vector2d centre = (square.points[0] + square.points[2]) / 2.0;
  double depth = 0.0;
  for (const ConvexPart& part : footprint.parts()) {
    const double discs_m = part.disc().radius_m + footprint.margin() + resolution_m * M_SQRT1_2;
    if ((part.disc().centre_m - centre).squaredNorm() > discs_m * discs_m) continue;
    for (std::uint32_t run = map.first_run[column]; run < map.first_run[column + 1]; ++run) {
      depth = std::max(
          depth, depthInCells(square, part, footprint.margin(), map.runs[run].low * resolution_m,
                              map.runs[run].high * resolution_m));
    }
  }
  return depth > kContactTolerance_m ? depth : 0.0;
}

double PlacedFootprint::depthIn(const MapColumns& map, std::size_t column) const {
  const Eigen::Vector2d corner = columnCorner(map.columns, column);
  const Shadow square =
      transformed(solid_T_map_, rectangle(corner, corner.array() + map.columns.resolution_m));
  return depthInColumn(footprint_, square, map, column);
}

double PlacedFootprint::depthOutside(const Eigen::Vector2d& min_m,
                                     const Eigen::Vector2d& max_m) const {
  double depth = 0.0;
  for (const ConvexPart& part : footprint_.parts()) {
    Eigen::Vector2d low;
    Eigen::Vector2d high;
    shadowBounds(transformed(map_T_solid_, part.shadow()), &low, &high);
    const double beyond = std::max((min_m - low).maxCoeff(), (high - max_m).maxCoeff());
    depth = std::max(depth, beyond + footprint_.margin());
  }
  return depth > kContactTolerance_m ? depth : 0.0;
}

}  // namespace casepush
