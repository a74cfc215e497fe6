#include "dead_end_check.h"

#include <algorithm>
#include <utility>

namespace casepush {
namespace {

constexpr double kSpread = 2.0;
constexpr int kPushes = 3;
// Where so many did not fit it is left open whether others do: all chains of 14 cases.
constexpr int kMostTests = 14 * (1 + 14 * (1 + 14));

}  // namespace

DeadEndCheck::DeadEndCheck(const PlanRequest& request, int case_count, GetCase cases,
                           PushChecker* checker, ApproachVerifier* approaches)
    : request_(request),
      case_count_(case_count),
      cases_(std::move(cases)),
      checker_(checker),
      approaches_(approaches) {}

bool DeadEndCheck::mayEndInOne(const Pose2& map_T_start, const PreparedCase& push) {
  const auto ends = sigmaPoints(push.start_outcome, kSpread);
  return std::any_of(ends.begin(), ends.end(), [&](const Pose2& start_T_end) {
    tests_left_ = kMostTests;
    return !canGoOn(map_T_start * start_T_end, push, kPushes);
  });
}

bool DeadEndCheck::canGoOn(const Pose2& map_T_object, const PreparedCase& previous, int pushes) {
  if (request_.tolerance.isMet(request_.map_T_goal, map_T_object)) return true;
  for (int i = 0; i < case_count_; ++i) {
    if (--tests_left_ < 0) return true;
    const int index = (last_ + i) % case_count_;
    const PreparedCase& next = cases_(index);
    if (!checker_->isSafe(next, map_T_object) ||
        !approaches_->canApproachSimply(map_T_object, &previous, next)) {
      continue;
    }
    if (pushes == 1 || canGoOn(map_T_object * next.start_outcome.mean, next, pushes - 1)) {
      last_ = index;
      return true;
    }
  }
  return false;
}

}  // namespace casepush
