#pragma once

#include <optional>
#include <string>

#include "bystanders.h"
#include "casepush/execution/execute_push.h"
#include "path_follower.h"
#include "watches.h"

namespace casepush {

/// Brings the robot to where a push starts, beside an object at rest.
class ApproachMotion {
 public:
  ApproachMotion(std::string object_id, const PushTrajectory& trajectory, const RobotLimits& limits,
                 ApproachPlanner planner, const ExecutePushOptions& options);

  struct Failure {
    PushOutcome outcome;
    std::string explanation;
  };
  struct Step {
    Twist2 wanted;         ///< Before limits.
    bool arrived = false;  ///< In place, and the object has been seen at rest.
    std::optional<Failure> failure;
  };

  /// @param object  Last usable state; nullptr if the object was never seen.
  Step step(const Observation& observation, const ObjectState* object, double dt_s);

  bool docking() const { return follower_ && follower_->docking(); }
  std::string describe() const;

 private:
  enum class Stage { kWait, kFollow, kSettle };
  Step wait(const Observation& observation, const ObjectState* object);
  Step plan(const Observation& observation, const ObjectState& object);
  Step follow(const Observation& observation, const ObjectState& object, double dt_s);
  Step settle(const Observation& observation, const ObjectState& object);
  Step fail(PushOutcome outcome, const std::string& explanation) const;
  bool hasShifted(const ObjectState& object, double position_m, double yaw_rad) const;
  bool isInPlace(const Observation& observation, const Pose2& map_T_start) const;
  Pose2 startPose(const ObjectState& object) const;

  std::string object_id_;
  Pose2 object_T_start_;
  double object_yaw_direction_;
  RobotLimits limits_;
  ApproachPlanner planner_;
  ExecutePushOptions options_;

  Stage stage_ = Stage::kWait;
  std::optional<double> stage_began_s_;
  std::optional<double> stalled_since_s_;
  double last_remaining_ = 0.0;
  std::optional<PathFollower> follower_;
  Bystanders bystanders_;
  Pose2 planned_map_T_start_;
  RestWatch rest_;
  int plans_ = 0;
  int docks_ = 0;
};

}  // namespace casepush
