#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/geometry.h"

namespace casepush {

/// Overlaps that are not deeper than this are contacts, not collisions [m].
constexpr double kContactTolerance_m = 1e-6;

/// What a convex part covers in the horizontal plane: a convex polygon grown by a radius.
struct Shadow {
  static constexpr int kMaxPoints = 48;
  std::array<Eigen::Vector2d, kMaxPoints> points;  ///< Counter-clockwise; one point for a disc.
  int count = 0;                                   ///< 0: covers nothing.
  double radius_m = 0.0;

  bool empty() const { return count == 0; }
};

/// Shadow given in frame b, in frame a.
Shadow transformed(const Pose2& a_T_b, const Shadow& b_shadow);

/// A disc that covers the shadow; conservative, not the smallest.
struct BoundingDisc {
  Eigen::Vector2d centre_m{0.0, 0.0};
  double radius_m = 0.0;
};
BoundingDisc boundingDisc(const Shadow& shadow);

/// Convex hull of points. @pre it has at most Shadow::kMaxPoints corners.
Shadow convexHull(std::vector<Eigen::Vector2d> points);

/// Axis-aligned rectangle.
Shadow rectangle(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m);

/// Distance of two shadows; if they overlap, minus the depth of the overlap [m].
/// Exact distance; the depth of two polygons is that of the smallest separating translation.
/// @pre neither is empty.
double separation(const Shadow& a, const Shadow& b);

/// Signed distance of a point from a shadow, negative inside [m]. @pre not empty.
double separation(const Shadow& shadow, const Eigen::Vector2d& point);

/// `separation(a, b) < limit_m`, faster.
bool closerThan(const Shadow& a, const Shadow& b, double limit_m);

/// One shape of a solid, prepared for questions about horizontal slabs of it.
///
/// Boxes in any orientation, upright cylinders and spheres are represented exactly (upright: within
/// 0.05 mrad); a tilted cylinder by its circumscribed 16-sided prism, at most 2 % of the radius
/// more.
class ConvexPart {
 public:
  explicit ConvexPart(const PlacedShape& shape);

  /// Shadow of what lies strictly between two heights, in the solid's frame. Empty if nothing does.
  Shadow shadow(double low_m, double high_m) const;

  /// Shadow of the whole part.
  const Shadow& shadow() const { return outline_; }

  const HeightRange& heights() const { return heights_; }
  const BoundingDisc& disc() const { return disc_; }  ///< Around shadow().
  double reach() const { return reach_m_; }   ///< Largest horizontal distance from the origin [m].
  bool isPrism() const { return is_prism_; }  ///< Same shadow at each of its heights.
  bool isSphere() const { return is_sphere_; }
  const std::string& name() const { return name_; }

  /// True if the part has something strictly between the two heights.
  bool touches(double low_m, double high_m) const {
    return heights_.low_m < high_m - kContactTolerance_m &&
           heights_.high_m > low_m + kContactTolerance_m;
  }

 private:
  void makeDisc(const Eigen::Vector3d& centre, double radius_m, double half_height_m);
  void makePolytope(std::vector<Eigen::Vector3d> vertices, std::vector<std::array<int, 2>> edges);

  std::string name_;
  HeightRange heights_{0.0, 0.0};
  double reach_m_ = 0.0;
  bool is_prism_ = false;
  bool is_sphere_ = false;
  BoundingDisc disc_;
  Shadow outline_;  ///< Of the whole part; for a sphere its equator.
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<int, 2>> edges_;  ///< Of polytopes that are no prisms.
};

std::vector<ConvexPart> convexParts(const Solid& solid);

/// How deep two placed parts overlap horizontally [m], the first one grown by `margin_m`
/// horizontally; 0 if they do not.
///
/// Exact if one of them is a prism (upright box or cylinder) or both are spheres. Otherwise both
/// are compared in 16 common slabs, which never misses an overlap and may report one where the true
/// gap is less than what the shapes' sides lean over within a slab.
double overlapDepth(const ConvexPart& a, const Pose2& map_T_a, const ConvexPart& b,
                    const Pose2& map_T_b, double margin_m);

}  // namespace casepush
