#pragma once

#include <map>

namespace casepush {

/// Why the rest of a plan was given up.
enum class ReplanCause {
  kPredictionRejected,  ///< The object rests where the case says it hardly ever does.
  kLeftTube,            ///< The push was broken off: the object left the course that the case says.
  kRestMissesGoal,      ///< The rest, begun at the observed pose, would end too far from the goal.
  kRestCollides,        ///< It would hit something, or uses a case that is gone.
  kDeadEndAhead,        ///< The next push may leave the object where no case can be applied.
  kEndedBesideGoal,     ///< All pushes of the plan are made, and the object is not at the goal.
  kApproachFailed,      ///< The robot did not get to where the next push starts.
  kPushFailed,          ///< The push did not end well: object lost, no rest, robot stuck.
  kObjectMoved,         ///< The object was moved while the plan was made.
  kObstacleStuck,       ///< Another object could not be pushed out of the way.
  kStoppedShort,        ///< The object was about to touch something during the push.
};
inline constexpr ReplanCause kReplanCauses[] = {
    ReplanCause::kPredictionRejected, ReplanCause::kLeftTube,     ReplanCause::kRestMissesGoal,
    ReplanCause::kRestCollides,       ReplanCause::kDeadEndAhead, ReplanCause::kEndedBesideGoal,
    ReplanCause::kApproachFailed,     ReplanCause::kPushFailed,   ReplanCause::kObjectMoved,
    ReplanCause::kObstacleStuck,      ReplanCause::kStoppedShort,
};

/// As in JSON: "prediction_rejected", "left_tube", ...
const char* toString(ReplanCause cause);

/// How often each cause made a plan be given up.
using ReplanCounts = std::map<ReplanCause, int>;

}  // namespace casepush
