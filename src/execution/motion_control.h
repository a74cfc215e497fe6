#pragma once

#include "casepush/common/pose2.h"
#include "casepush/model/robot_model.h"

namespace casepush {

/// Keeps commands within the robot's limits of speed and acceleration.
class CommandLimiter {
 public:
  explicit CommandLimiter(const RobotLimits& limits) : limits_(limits) {}

  Twist2 limit(const Twist2& wanted, double dt_s);
  void stop() { last_ = Twist2{}; }

 private:
  RobotLimits limits_;
  Twist2 last_;
};

struct TrackingGains {
  double position_per_s;
  double yaw_per_s;
};

/// Where the robot should be now, and the velocity there in the frame of that pose.
struct Reference {
  Pose2 map_T_reference;
  Twist2 action;
};

/// Command in the robot frame: the reference's action plus feedback on the error (both bounded by
/// the limiter later; the feedback alone never asks for more than a quarter metre per second).
Twist2 track(const Pose2& map_T_robot, const Reference& reference, const TrackingGains& gains);

}  // namespace casepush
