#pragma once

#include <deque>
#include <optional>

#include "casepush/model/observation.h"

namespace casepush {

/// Does something hold the robot? It does if the robot was moving and has hardly moved for a fifth
/// of a second though it was told to; or if it does not start for a second. Goes by the robot's
/// pose in the map: wheels may turn on the spot.
class BlockedWatch {
 public:
  /// To be asked once a tick.
  /// @param commanded  What the base was told at the last tick, in the robot frame.
  bool isBlocked(const Observation& observation, const Twist2& commanded);

  void reset();

 private:
  enum class Motion { kUnknown, kFollows, kHeld };
  Motion lastMotion() const;

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
