#pragma once

#include <string>

#include "casepush/execution/push_task.h"
#include "casepush/execution/replan_cause.h"

namespace casepush {

/// What to do about the rest of a plan.
struct RestVerdict {
  bool goes_on = false;
  ReplanCause cause = ReplanCause::kRestMissesGoal;  ///< If it does not go on,
  std::string why;                                   ///< and in words.
};

/// A rest that collides within the next pushes is given up. One whose mean ends beside the goal
/// goes on as long as RestOptions say that this makes little difference.
RestVerdict judgeRest(const PushPlanner::Continuation& rest, const RestOptions& options);

}  // namespace casepush
