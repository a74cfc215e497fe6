#pragma once

#include <cstdint>

#include "casepush/common/pose2.h"

namespace casepush {

/// Number of the cell of SE(2) that a pose, its yaw in (-pi, pi], lies in: `cell_m` wide in x, y
/// and in yaw times `rho_m`.
inline std::uint64_t poseCell(double x_m, double y_m, double yaw_rad, double cell_m, double rho_m) {
  // Maps indices of either sign into 21 bits; what is positive is rounded down by conversion.
  constexpr double kOffset = (1 << 20) + 0.5;
  const auto index = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value + kOffset)) & 0x1fffff;
  };
  return index(x_m / cell_m) << 42 | index(y_m / cell_m) << 21 | index(yaw_rad * rho_m / cell_m);
}
inline std::uint64_t poseCell(const Pose2& pose, double cell_m, double rho_m) {
  return poseCell(pose.x(), pose.y(), pose.yaw(), cell_m, rho_m);
}

}  // namespace casepush
