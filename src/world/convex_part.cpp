#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"
#include "casepush/world/shadow.h"

namespace casepush {
namespace {

constexpr int kPrismSides = 16;
constexpr double kUprightTolerance = 1e-9;  // 1 - cos(0.05 mrad)

using Edges = std::vector<std::array<int, 2>>;

std::vector<Eigen::Vector3d> boxVertices(const Box& box, const Eigen::Isometry3d& frame_T_box) {
  std::vector<Eigen::Vector3d> vertices;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5,
                               corner & 4 ? 0.5 : -0.5);
    vertices.push_back(frame_T_box * sign.cwiseProduct(box.size_m));
  }
  return vertices;
}

Edges boxEdges() {
  Edges edges;
  for (int corner = 0; corner < 8; ++corner) {
    for (int bit = 1; bit < 8; bit <<= 1) {
      if (!(corner & bit)) edges.push_back({corner, corner | bit});
    }
  }
  return edges;
}

/// Prism around the cylinder; vertices 2 i and 2 i + 1 are the ends of side edge i.
std::vector<Eigen::Vector3d> prismVertices(const Cylinder& cylinder,
                                           const Eigen::Isometry3d& frame_T_cylinder) {
  std::vector<Eigen::Vector3d> vertices;
  const double radius_m = cylinder.radius_m / std::cos(M_PI / kPrismSides);
  for (int i = 0; i < kPrismSides; ++i) {
    const double angle = (2 * i + 1) * M_PI / kPrismSides;
    for (const double end : {-0.5, 0.5}) {
      vertices.push_back(frame_T_cylinder * Eigen::Vector3d(radius_m * std::cos(angle),
                                                            radius_m * std::sin(angle),
                                                            end * cylinder.length_m));
    }
  }
  return vertices;
}

Edges prismEdges() {
  Edges edges;
  for (int i = 0; i < kPrismSides; ++i) {
    const int next = (i + 1) % kPrismSides;
    edges.push_back({2 * i, 2 * i + 1});
    edges.push_back({2 * i, 2 * next});
    edges.push_back({2 * i + 1, 2 * next + 1});
  }
  return edges;
}

bool hasVerticalAxis(const Eigen::Matrix3d& rotation) {
  return rotation.row(2).cwiseAbs().maxCoeff() > 1.0 - kUprightTolerance;
}

}  // namespace

ConvexPart::ConvexPart(const PlacedShape& shape) : name_(shape.part) {
  const Eigen::Isometry3d& frame_T_shape = shape.frame_T_shape;
  const Eigen::Vector3d centre = frame_T_shape.translation();
  if (const auto* box = std::get_if<Box>(&shape.shape)) {
    makePolytope(boxVertices(*box, frame_T_shape), boxEdges());
    is_prism_ = hasVerticalAxis(frame_T_shape.linear());
  } else if (const auto* sphere = std::get_if<Sphere>(&shape.shape)) {
    makeDisc(centre, sphere->radius_m, sphere->radius_m);
    is_sphere_ = true;
  } else {
    const auto& cylinder = std::get<Cylinder>(shape.shape);
    is_prism_ = std::abs(frame_T_shape.linear()(2, 2)) > 1.0 - kUprightTolerance;
    if (is_prism_) {
      makeDisc(centre, cylinder.radius_m, cylinder.length_m / 2.0);
    } else {
      makePolytope(prismVertices(cylinder, frame_T_shape), prismEdges());
    }
  }
  disc_ = boundingDisc(outline_);
}

void ConvexPart::makeDisc(const Eigen::Vector3d& centre, double radius_m, double half_height_m) {
  outline_.count = 1;
  outline_.points[0] = centre.head<2>();
  outline_.radius_m = radius_m;
  heights_ = {centre.z() - half_height_m, centre.z() + half_height_m};
  reach_m_ = centre.head<2>().norm() + radius_m;
}

void ConvexPart::makePolytope(std::vector<Eigen::Vector3d> vertices, Edges edges) {
  std::vector<Eigen::Vector2d> points;
  heights_ = {vertices[0].z(), vertices[0].z()};
  for (const auto& vertex : vertices) {
    points.push_back(vertex.head<2>());
    heights_.low_m = std::min(heights_.low_m, vertex.z());
    heights_.high_m = std::max(heights_.high_m, vertex.z());
    reach_m_ = std::max(reach_m_, vertex.head<2>().norm());
  }
  outline_ = convexHull(std::move(points));
  vertices_ = std::move(vertices);
  edges_ = std::move(edges);
}

Shadow ConvexPart::shadow(double low_m, double high_m) const {
  if (!touches(low_m, high_m)) return Shadow();
  if (is_prism_ || (low_m <= heights_.low_m && high_m >= heights_.high_m)) return outline_;
  if (is_sphere_) {
    Shadow result = outline_;
    const double centre_z = (heights_.low_m + heights_.high_m) / 2.0;
    const double off_m = std::clamp(centre_z, low_m, high_m) - centre_z;
    result.radius_m = std::sqrt(std::max(0.0, std::pow(outline_.radius_m, 2) - off_m * off_m));
    return result;
  }
  std::vector<Eigen::Vector2d> points;
  for (const auto& vertex : vertices_) {
    if (vertex.z() >= low_m && vertex.z() <= high_m) points.push_back(vertex.head<2>());
  }
  for (const auto& [from, to] : edges_) {
    const Eigen::Vector3d& a = vertices_[from];
    const Eigen::Vector3d& b = vertices_[to];
    for (const double z : {low_m, high_m}) {
      if ((a.z() < z) == (b.z() < z)) continue;
      points.push_back((a + (z - a.z()) / (b.z() - a.z()) * (b - a)).head<2>());
    }
  }
  return convexHull(std::move(points));
}

std::vector<ConvexPart> convexParts(const Solid& solid) {
  return std::vector<ConvexPart>(solid.begin(), solid.end());
}

}  // namespace casepush
