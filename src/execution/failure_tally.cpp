#include "failure_tally.h"

#include <numeric>

namespace casepush {
namespace {

constexpr int kBlindAfter = 15;

}  // namespace

bool FailureTally::isNoFaultOfThePush(PushOutcome outcome) {
  return outcome == PushOutcome::kObjectLost || outcome == PushOutcome::kRobotLost ||
         outcome == PushOutcome::kCancelled;
}

void FailureTally::add(PushOutcome outcome) {
  ++counts_.at(static_cast<std::size_t>(outcome));
  out_of_sight_in_row_ = isNoFaultOfThePush(outcome) ? out_of_sight_in_row_ + 1 : 0;
}

bool FailureTally::isBlind() const { return out_of_sight_in_row_ >= kBlindAfter; }

int FailureTally::total() const { return std::accumulate(counts_.begin(), counts_.end(), 0); }

std::string FailureTally::describe() const {
  if (isBlind()) {
    return "stopped: object or robot was out of sight in " + std::to_string(kBlindAfter) +
           " pushes in a row; check cameras, tags and localisation (what was learnt is kept)";
  }
  std::string reasons;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] > 0) {
      const auto outcome = static_cast<PushOutcome>(i);
      reasons += (reasons.empty() ? "" : ", ") + std::to_string(counts_[i]) + " " +
                 (outcome == PushOutcome::kDone ? "too small or known already" : toString(outcome));
    }
  }
  return "gave up after " + std::to_string(total()) + " useless pushes (" + reasons +
         "); check that the robot can reach and move the object";
}

}  // namespace casepush
