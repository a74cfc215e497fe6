#pragma once

#include <Eigen/Core>
#include <vector>

#include "casepush/world/collision_checker.h"

namespace casepush {

/// A lower bound of the horizontal distance to the nearest obstacle of any height, for accepting
/// poses in the open at the price of one look-up.
///
/// What lies outside of the columns counts as occupied.
class ClearanceField {
 public:
  explicit ClearanceField(const CollisionChecker::Columns& columns);

  /// Nothing occupied is nearer than this; at most 0 close to obstacles and outside [m].
  float at(const Eigen::Vector2d& point_m) const {
    const double x = (point_m.x() - origin_m_.x()) * cells_per_m_;
    const double y = (point_m.y() - origin_m_.y()) * cells_per_m_;
    if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) {
      return 0.0F;
    }
    return clearance_m_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
  }

 private:
  Eigen::Vector2d origin_m_;
  double cells_per_m_;
  int width_;
  int height_;
  std::vector<float> clearance_m_;
};

}  // namespace casepush
