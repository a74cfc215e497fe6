#include "way.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr int kCorners = 12;  // Of the polygon around a disc: 3.5 % wider at its corners.

void addCorners(const Shadow& shadow, std::vector<Eigen::Vector2d>* points) {
  if (shadow.radius_m <= 0.0) {
    points->insert(points->end(), shadow.points.begin(), shadow.points.begin() + shadow.count);
    return;
  }
  const double radius_m = shadow.radius_m / std::cos(M_PI / kCorners);
  for (int i = 0; i < shadow.count; ++i) {
    for (int k = 0; k < kCorners; ++k) {
      const double angle = 2.0 * M_PI * k / kCorners;
      points->push_back(shadow.points[i] +
                        radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
}

}  // namespace

Shadow outlineOf(const Solid& solid) {
  std::vector<Eigen::Vector2d> points;
  for (const ConvexPart& part : convexParts(solid)) addCorners(part.shadow(), &points);
  return convexHull(std::move(points));
}

void Way::add(const Shadow& outline, const Pose2& map_T_body) {
  const Shadow map_outline = transformed(map_T_body, outline);
  stations_.push_back({map_outline, boundingDisc(map_outline)});
}

double Way::distance(const Shadow& outline, const Pose2& map_T_body, double limit_m) const {
  const Shadow map_outline = transformed(map_T_body, outline);
  const BoundingDisc disc = boundingDisc(map_outline);
  double nearest_m = limit_m;
  for (const Station& station : stations_) {
    const double reach_m = station.disc.radius_m + disc.radius_m;
    if ((station.disc.centre_m - disc.centre_m).norm() - reach_m >= nearest_m) continue;
    nearest_m = std::min(nearest_m, separation(station.map_outline, map_outline));
  }
  return nearest_m;
}

}  // namespace casepush
