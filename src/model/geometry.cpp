#include "casepush/model/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/check.h"

namespace casepush {
namespace {

/// Largest distance of the shape's points from its centre along a unit direction in its own frame.
double support(const Shape& shape, const Eigen::Vector3d& direction) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return 0.5 * box->size_m.dot(direction.cwiseAbs());
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return 0.5 * cylinder->length_m * std::abs(direction.z()) +
           cylinder->radius_m * direction.head<2>().norm();
  }
  return std::get<Sphere>(shape).radius_m;
}

/// The same, measured from the frame's origin along a direction in the frame.
double support(const PlacedShape& placed, const Eigen::Vector3d& frame_direction) {
  return placed.frame_T_shape.translation().dot(frame_direction) +
         support(placed.shape, placed.frame_T_shape.linear().transpose() * frame_direction);
}

}  // namespace

double circumscribedRadius(const Solid& solid) {
  // The farthest point, at distance D in direction u*, has support D cos(u - u*) along u: sampling
  // every 0.5 degrees and dividing by the cosine of half of that never underestimates.
  constexpr int kDirections = 720;
  double radius_m = 0.0;
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kDirections;
    const Eigen::Vector3d direction(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    for (const PlacedShape& shape : solid) {
      radius_m = std::max(radius_m, support(shape, direction));
    }
  }
  return radius_m / std::cos(M_PI / kDirections);
}

HeightRange heightRange(const PlacedShape& shape) {
  return {-support(shape, -Eigen::Vector3d::UnitZ()), support(shape, Eigen::Vector3d::UnitZ())};
}

HeightRange heightRange(const Solid& solid) {
  CASEPUSH_CHECK(!solid.empty(), "height of nothing");
  HeightRange range = heightRange(solid.front());
  for (const PlacedShape& shape : solid) {
    const HeightRange one = heightRange(shape);
    range.low_m = std::min(range.low_m, one.low_m);
    range.high_m = std::max(range.high_m, one.high_m);
  }
  return range;
}

}  // namespace casepush
