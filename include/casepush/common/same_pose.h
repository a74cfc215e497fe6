#pragma once

#include "casepush/common/pose2.h"

namespace casepush {

/// The same pose to the last bit: poses of different observations never agree in that.
inline bool isSame(const Pose2& a, const Pose2& b) {
  return a.x() == b.x() && a.y() == b.y() && a.yaw() == b.yaw();
}

}  // namespace casepush
