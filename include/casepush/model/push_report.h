#pragma once

#include <cstdint>
#include <string>

#include "casepush/common/pose_gaussian.h"
#include "casepush/model/case.h"

namespace casepush {

/// Outcome of the test "did the object end up where the case said" (method: Hotelling's T^2).
struct PredictionTest {
  double t_squared = 0.0;  ///< Generalised squared distance; 0 if untested.
  double p_value = 1.0;    ///< Probability of a deviation at least this large if the case is right.
  bool rejected = false;   ///< p_value < alpha, or the object left its course on the way.
};

/// How a single push ended.
enum class PushOutcome {
  kDone,  ///< Pushed, and the object is at rest.
  kCancelled,
  kApproachFailed,  ///< No path to the push's start pose.
  kObjectLost,      ///< Not seen for too long.
  kRobotLost,       ///< The robot's own pose is stale.
  kNotMoved,        ///< The object did not move.
  kTimeout,
  kBrokenOff,     ///< The object left the course that the case says, so that the robot stopped.
  kBlocked,       ///< The robot did not get along as commanded: something holds it.
  kStoppedShort,  ///< The object was about to touch something, so that the robot stopped.
};
inline constexpr PushOutcome kLastPushOutcome = PushOutcome::kStoppedShort;
const char* toString(PushOutcome outcome);

/// Everything known about one executed push. Poses are in the map frame unless named otherwise.
struct PushReport {
  std::string object_id;
  std::int64_t case_id = 0;  ///< 0 for a push tried for the first time.
  PushOutcome outcome = PushOutcome::kCancelled;
  std::string explanation;
  double start_stamp_s = 0.0;  ///< When the push proper began.
  double end_stamp_s = 0.0;    ///< When the object had come to rest.
  Pose2 map_T_start;           ///< Object before the push.
  Pose2 map_T_end;             ///< Object at rest, as observed.
  PoseGaussian map_expected;   ///< The case's prediction; meaningless if case_id == 0.
  PredictionTest test;
  Case recorded;  ///< The push as it happened, statistics of this one observation.
};

}  // namespace casepush
