#pragma once

#include <cmath>

#include "casepush/common/pose2.h"

namespace casepush {

/// The same as wrapAngle(), bit by bit, of the sum or difference of two angles in (-pi, pi].
inline double wrapTurn(double angle_rad) {
  if (angle_rad > M_PI) return angle_rad - 2.0 * M_PI;
  return angle_rad <= -M_PI ? angle_rad + 2.0 * M_PI : angle_rad;
}

/// A pose at which many pushes are looked at: its trigonometry is worked out once.
class PushStart {
 public:
  explicit PushStart(const Pose2& map_T_start)
      : map_T_start_(map_T_start),
        cosine_(std::cos(map_T_start.yaw())),
        sine_(std::sin(map_T_start.yaw())) {}

  /// The same as `map_T_start * start_T_end`, bit by bit.
  Pose2 operator*(const Pose2& start_T_end) const {
    const Eigen::Vector2d end = positionOf(start_T_end);
    return {end.x(), end.y(), map_T_start_.yaw() + start_T_end.yaw()};
  }

  Eigen::Vector2d positionOf(const Pose2& start_T_end) const {
    return {map_T_start_.x() + cosine_ * start_T_end.x() - sine_ * start_T_end.y(),
            map_T_start_.y() + sine_ * start_T_end.x() + cosine_ * start_T_end.y()};
  }

  /// The heading, in (-pi, pi] [rad].
  double yawOf(const Pose2& start_T_end) const {
    return wrapTurn(map_T_start_.yaw() + start_T_end.yaw());
  }

  /// A vector of the map in the start's frame.
  Eigen::Vector2d turnedBack(const Eigen::Vector2d& vector) const {
    return {cosine_ * vector.x() + sine_ * vector.y(), cosine_ * vector.y() - sine_ * vector.x()};
  }

 private:
  Pose2 map_T_start_;
  double cosine_;
  double sine_;
};

}  // namespace casepush
