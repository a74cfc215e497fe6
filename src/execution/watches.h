#pragma once

#include <optional>

#include "casepush/common/silence_timer.h"
#include "casepush/execution/execute_push.h"
#include "casepush/model/observation.h"

namespace casepush {

/// Is the robot's own pose fit to act on?
class RobotWatch {
 public:
  enum class Status { kFresh, kStale, kLost };

  explicit RobotWatch(double stale_s) : stale_s_(stale_s) {}

  /// kStale: not finite or too old, so that the robot must stand still; kLost: for over 2 s of
  /// ticks, whatever the clock says. To be asked at every tick.
  Status check(const Observation& observation);

 private:
  double stale_s_;
  SilenceTimer silence_;
};

/// Time between ticks.
class TickClock {
 public:
  /// Seconds since the last tick, in [0, 0.2]; nothing if time went back by more than half a second
  /// (a simulator that was started anew). @pre stamp_s is finite.
  std::optional<double> advance(double stamp_s);

 private:
  std::optional<double> last_s_;
};

/// Is an object at rest? Slow and at the same pose for a while, by what was seen: time in which it
/// is not seen does not count.
class RestWatch {
 public:
  explicit RestWatch(const ExecutePushOptions& options);

  bool isAtRest(const ObjectState& object);

  /// When the present rest began, by the object's stamps. @pre isAtRest() said true last.
  double sinceS() const { return began_s_; }
  void reset();

 private:
  double speed_mps_;
  double yaw_rate_rps_;
  double time_s_;
  std::optional<double> last_stamp_s_;
  Pose2 began_at_;
  double began_s_ = 0.0;
  bool at_rest_ = false;
};

/// Is something holding the robot, so that it does not get to where it should be?
class HoldWatch {
 public:
  HoldWatch(double far_m, double time_s) : far_m_(far_m), time_s_(time_s) {}

  /// @param off_m  Distance of the robot from where it should be now.
  bool isHeld(double now_s, double off_m);

 private:
  double far_m_;
  double time_s_;
  std::optional<double> far_since_s_;
};

/// True if pose, twist and stamp are finite.
bool isUsable(const ObjectState& object);

/// The object's state, or nullptr if it was never seen or is not finite.
const ObjectState* usableObject(const Observation& observation, const std::string& id);

}  // namespace casepush
