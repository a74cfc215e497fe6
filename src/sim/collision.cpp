#include "collision.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <variant>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

// Bullet's default margin of 4 cm rounds edges and swallows thin shapes.
double marginFor(double smallest_half_extent_m) {
  return std::min(0.003, 0.1 * smallest_half_extent_m);
}

struct ShapeMaker {
  std::unique_ptr<btConvexInternalShape> operator()(const Box& box) const {
    const Eigen::Vector3d half_m = 0.5 * box.size_m;
    auto shape = std::make_unique<btBoxShape>(toBullet(half_m));
    shape->setMargin(marginFor(half_m.minCoeff()));
    return shape;
  }
  std::unique_ptr<btConvexInternalShape> operator()(const Cylinder& cylinder) const {
    const double r = cylinder.radius_m;
    auto shape = std::make_unique<btCylinderShapeZ>(btVector3(r, r, 0.5 * cylinder.length_m));
    shape->setMargin(marginFor(std::min(r, 0.5 * cylinder.length_m)));
    return shape;
  }
  std::unique_ptr<btConvexInternalShape> operator()(const Sphere& sphere) const {
    return std::make_unique<btSphereShape>(sphere.radius_m);
  }
};

}  // namespace

const std::string& CollisionTag::part(int child) const {
  static const std::string kUnknown;
  if (parts.empty()) return kUnknown;
  return parts[static_cast<std::size_t>(
      std::clamp<int>(child, 0, static_cast<int>(parts.size()) - 1))];
}

std::unique_ptr<btConvexInternalShape> makeShape(const Shape& shape) {
  return std::visit(ShapeMaker(), shape);
}

void CompoundShape::add(const PlacedShape& placed, const Eigen::Isometry3d& body_T_frame) {
  children_.push_back(makeShape(placed.shape));
  parts_.push_back(placed.part);
  compound_->addChildShape(toBullet(body_T_frame * placed.frame_T_shape), children_.back().get());
}

}  // namespace casepush::sim
