#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

namespace casepush {

struct Box {
  Eigen::Vector3d size_m;  ///< Full edge lengths.
};
struct Cylinder {
  double radius_m;
  double length_m;  ///< Along z, centred on the origin.
};
struct Sphere {
  double radius_m;
};
using Shape = std::variant<Box, Cylinder, Sphere>;

/// A shape in a frame, with the name of the link or part that it belongs to.
struct PlacedShape {
  Shape shape;
  Eigen::Isometry3d frame_T_shape = Eigen::Isometry3d::Identity();
  std::string part;
};

/// A rigid thing as the collision checker sees it: shapes in its own frame, whose z = 0 is the
/// floor.
using Solid = std::vector<PlacedShape>;

/// Largest horizontal distance of any point of the solid from its origin [m].
double circumscribedRadius(const Solid& solid);

/// Lowest and highest z of a shape in the solid's frame [m].
struct HeightRange {
  double low_m;
  double high_m;
};
HeightRange heightRange(const PlacedShape& shape);
HeightRange heightRange(const Solid& solid);

}  // namespace casepush
