#include "casepush/execution/replan_cause.h"

namespace casepush {

const char* toString(ReplanCause cause) {
  switch (cause) {
    case ReplanCause::kPredictionRejected:
      return "prediction_rejected";
    case ReplanCause::kLeftTube:
      return "left_tube";
    case ReplanCause::kRestMissesGoal:
      return "rest_misses_goal";
    case ReplanCause::kRestCollides:
      return "rest_collides";
    case ReplanCause::kDeadEndAhead:
      return "dead_end_ahead";
    case ReplanCause::kEndedBesideGoal:
      return "ended_beside_goal";
    case ReplanCause::kApproachFailed:
      return "approach_failed";
    case ReplanCause::kPushFailed:
      return "push_failed";
    case ReplanCause::kObjectMoved:
      return "object_moved";
    case ReplanCause::kObstacleStuck:
      return "obstacle_stuck";
    case ReplanCause::kStoppedShort:
      return "stopped_short";
  }
  return "unknown";
}

}  // namespace casepush
