#pragma once

#include <deque>

#include "casepush/model/observation.h"

namespace casepush {

/// Does something hold the robot? It does if the robot has hardly moved for a fifth of a second
/// though it was told to. Goes by the robot's pose in the map: wheels may turn on the spot.
class BlockedWatch {
 public:
  /// To be asked once a tick.
  /// @param commanded  What the base was told at the last tick, in the robot frame.
  bool isBlocked(const Observation& observation, const Twist2& commanded);

  void reset() { past_.clear(); }

 private:
  struct Sample {
    double stamp_s;
    Pose2 map_T_robot;
    double commanded_m;  ///< Travel that was asked for since the first sample; a turn counts too.
  };
  std::deque<Sample> past_;  ///< Oldest first; the first is as old as the time looked at, or older.
};

}  // namespace casepush
