#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>

#include <memory>
#include <string>
#include <vector>

#include "casepush/model/geometry.h"

namespace casepush::sim {

enum CollisionGroup : int {
  kFloorGroup = 1,
  kStaticGroup = 2,
  kFurnitureGroup = 4,
  kWheelGroup = 8,
  kRobotGroup = 16,
};

/// Contacts farther apart than this cost solver rows and do nothing: bodies close in by a few
/// millimetres per step.
constexpr double kContactRange_m = 0.006;

/// What the user pointer of every collision object points to: who it is, part by part.
struct CollisionTag {
  enum class Kind { kFloor, kStatic, kFurniture, kWheel, kRobot };
  Kind kind = Kind::kStatic;
  std::string body;                ///< Object id, "robot", or the name of a static box.
  std::vector<std::string> parts;  ///< By index of the child shape.
  int object = -1;                 ///< Index of the piece of furniture.
  int wheel = -1;                  ///< Index of its wheel.

  const std::string& part(int child) const;
};

/// A Bullet shape. Curved shapes are exact; boxes too, apart from edges rounded by the margin.
std::unique_ptr<btConvexInternalShape> makeShape(const Shape& shape);

/// Shapes that move together. Owns the children.
class CompoundShape {
 public:
  /// `body_T_frame` places the frame that the shapes are given in.
  void add(const PlacedShape& placed, const Eigen::Isometry3d& body_T_frame);

  bool isEmpty() const { return children_.empty(); }
  btCompoundShape* get() const { return compound_.get(); }
  const std::vector<std::string>& parts() const { return parts_; }

 private:
  std::vector<std::unique_ptr<btConvexInternalShape>> children_;
  std::vector<std::string> parts_;
  std::unique_ptr<btCompoundShape> compound_ = std::make_unique<btCompoundShape>();
};

}  // namespace casepush::sim
