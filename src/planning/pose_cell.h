#pragma once

#include <cstdint>

#include "casepush/common/pose2.h"

namespace casepush {

/// Number of a cell of SE(2), from coordinates in cells.
inline std::uint64_t cellNumber(double x, double y, double turn) {
  // Maps indices of either sign into 21 bits; what is positive is rounded down by conversion.
  constexpr double kOffset = (1 << 20) + 0.5;
  const auto index = [](double value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(value + kOffset)) & 0x1fffff;
  };
  return index(x) << 42 | index(y) << 21 | index(turn);
}

/// Number of the cell that a pose lies in: `cell_m` wide in x, y and in yaw times `rho_m`.
inline std::uint64_t poseCell(const Pose2& pose, double cell_m, double rho_m) {
  return cellNumber(pose.x() / cell_m, pose.y() / cell_m, pose.yaw() * rho_m / cell_m);
}

}  // namespace casepush
