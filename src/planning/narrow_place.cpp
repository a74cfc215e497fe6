#include "narrow_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/world/shadow.h"
#include "clearance_grid.h"

namespace casepush {
namespace {

constexpr int kDirections = 36;      // Of half a turn.
constexpr double kFarthest_m = 1.5;  // No gap is looked at that is twice as wide.

Eigen::Vector2d direction(int index) {
  const double angle_rad = M_PI * index / kDirections;
  return {std::cos(angle_rad), std::sin(angle_rad)};
}

/// The least width of an object's outline between two heights, over all directions.
double leastWidth(const std::vector<ConvexPart>& parts, double low_m, double high_m) {
  double least_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector2d across = direction(i);
    double from_m = std::numeric_limits<double>::infinity();
    double to_m = -from_m;
    for (const ConvexPart& part : parts) {
      const Shadow shadow = part.shadow(low_m, high_m);
      for (int k = 0; k < shadow.count; ++k) {
        const double at_m = shadow.points[k].dot(across);
        from_m = std::min(from_m, at_m - shadow.radius_m);
        to_m = std::max(to_m, at_m + shadow.radius_m);
      }
    }
    least_m = std::min(least_m, to_m - from_m);
  }
  return least_m;
}

/// How far one gets from a point before something is occupied in the slices.
double freeLength(const CollisionChecker::Columns& columns, std::uint64_t slices,
                  const Eigen::Vector2d& from_m, const Eigen::Vector2d& along) {
  const double step_m = 0.2 * columns.resolution_m;
  for (double length_m = 0.0; length_m < kFarthest_m; length_m += step_m) {
    const Eigen::Vector2d index =
        (from_m + length_m * along - columns.origin_m) / columns.resolution_m;
    const bool is_inside = index.x() >= 0.0 && index.y() >= 0.0 && index.x() < columns.width &&
                           index.y() < columns.height;
    if (!is_inside) return length_m;
    const std::size_t cell =
        static_cast<std::size_t>(index.y()) * columns.width + static_cast<std::size_t>(index.x());
    if ((columns.bits[cell] & slices) != 0) return length_m;
  }
  return kFarthest_m;
}

}  // namespace

std::optional<NarrowPlace> narrowestPlace(const CollisionChecker::Columns& columns,
                                          const Solid& object,
                                          const std::vector<Eigen::Vector2d>& points_m,
                                          const Patience& patience) {
  constexpr std::size_t kSteps = 2000;  // Of one point, for Patience.
  const std::vector<ConvexPart> parts = convexParts(object);
  std::optional<NarrowPlace> narrowest;
  for (const TravelDisc& heights : travelDiscs(object, 0.0)) {
    const std::uint64_t slices = slicesOf(heights, columns.slice_m);
    const double needed_m = leastWidth(parts, heights.low_m, heights.high_m);
    for (const Eigen::Vector2d& point_m : points_m) {
      if (patience.isOverAfter(kSteps)) return narrowest;
      double width_m = 2.0 * kFarthest_m;
      for (int i = 0; i < kDirections; ++i) {
        const Eigen::Vector2d along = direction(i);
        width_m = std::min(width_m, freeLength(columns, slices, point_m, along) +
                                        freeLength(columns, slices, point_m, -along));
      }
      const double lacking_m = needed_m - width_m;
      const double so_far_m = narrowest ? narrowest->needed_m - narrowest->width_m : 0.0;
      if (width_m > 0.0 && lacking_m > so_far_m) narrowest = {point_m, width_m, needed_m};
    }
  }
  return narrowest;
}

}  // namespace casepush
