#pragma once

#include <deque>
#include <optional>

#include "casepush/model/observation.h"

namespace casepush {

/// Does something hold the robot? It does if the robot was moving and for a fifth of a second has
/// not done what it was told; or if it does not start for a second. Goes by the robot's pose in the
/// map: wheels may turn on the spot.
class BlockedWatch {
 public:
  enum class Drive {
    kFree,  ///< Nothing to touch: held if half of the motion is missing, also if it slides along.
    kPushing,  ///< What it pushes may slow it down: held if it hardly moves.
  };

  /// To be asked once a tick. Says no when there is no newer pose of the robot.
  /// @param commanded  What the base was told at the last tick, in the robot frame.
  bool isBlocked(const Observation& observation, const Twist2& commanded, Drive drive);

  void reset();

 private:
  enum class Motion { kUnknown, kFollows, kHeld };
  Motion lastMotion(Drive drive) const;

  struct Sample {
    double stamp_s;
    Pose2 map_T_robot;
    Pose2 commanded;  ///< Where commands would have brought it since the first tick.
  };
  std::deque<Sample> past_;  ///< Oldest first; the first is as old as the time looked at, or older.
  std::optional<double> held_since_s_;
  bool follows_ = false;  ///< The robot did what it was told before it was held.
};

}  // namespace casepush
