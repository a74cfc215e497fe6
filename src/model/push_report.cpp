#include "casepush/model/push_report.h"

#include "casepush/common/check.h"

namespace casepush {

const char* toString(PushOutcome outcome) {
  switch (outcome) {
    case PushOutcome::kDone:
      return "done";
    case PushOutcome::kCancelled:
      return "cancelled";
    case PushOutcome::kApproachFailed:
      return "approach failed";
    case PushOutcome::kObjectLost:
      return "object lost";
    case PushOutcome::kRobotLost:
      return "robot lost";
    case PushOutcome::kNotMoved:
      return "not moved";
    case PushOutcome::kTimeout:
      return "timeout";
    case PushOutcome::kBrokenOff:
      return "broken off";
    case PushOutcome::kBlocked:
      return "blocked";
    case PushOutcome::kStoppedShort:
      return "stopped short";
  }
  CASEPUSH_CHECK(false, "PushOutcome " << static_cast<int>(outcome));
}

}  // namespace casepush
