#pragma once

#include <string>

#include "casepush/common/pose2.h"
#include "casepush/model/robot_model.h"

namespace casepush {

/// The last judge of what reaches the base: zero if poses are stale or a command is no good.
class CommandGuard {
 public:
  struct Verdict {
    Twist2 twist;        ///< As wanted, or zero.
    std::string reason;  ///< Why it is zero; empty if it is as wanted.
  };

  CommandGuard(const RobotLimits& limits, double stale_robot_s, double stale_objects_s)
      : limits_(limits), stale_robot_s_(stale_robot_s), stale_objects_s_(stale_objects_s) {}

  /// @param robot_age_s, objects_age_s  Since the robot's and the objects' poses were estimated.
  Verdict judge(const Twist2& wanted, double robot_age_s, double objects_age_s) const;

 private:
  RobotLimits limits_;
  double stale_robot_s_;
  double stale_objects_s_;
};

}  // namespace casepush
