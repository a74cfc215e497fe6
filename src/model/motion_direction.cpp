#include "casepush/model/motion_direction.h"

#include <cmath>

namespace casepush {

std::optional<double> motionDirection(const std::vector<Pose2>& poses) {
  constexpr double kClearMotion_m = 0.05;
  for (const Pose2& pose : poses) {
    const Eigen::Vector2d motion = pose.position() - poses.front().position();
    if (motion.norm() > kClearMotion_m) return std::atan2(motion.y(), motion.x());
  }
  return std::nullopt;
}

}  // namespace casepush
