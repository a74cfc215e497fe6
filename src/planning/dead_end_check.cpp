#include "dead_end_check.h"

#include <algorithm>
#include <utility>

#include "pose_cell.h"

namespace casepush {
namespace {

constexpr double kSpread = 2.0;
constexpr int kPushes = 8;
// Of poses so near to one another one is pushed on from.
constexpr double kCell_m = 0.1;
constexpr double kRho_m = 0.5;
// After so many tests, of all ends of a push, it is left open whether others fit.
constexpr int kMostTests = 2000;
constexpr int kTestsUnasked = 16;

}  // namespace

DeadEndCheck::DeadEndCheck(const PlanRequest& request, int case_count, GetCase cases,
                           PushChecker* checker, ApproachVerifier* approaches)
    : request_(request),
      case_count_(case_count),
      cases_(std::move(cases)),
      checker_(checker),
      approaches_(approaches) {}

bool DeadEndCheck::mayEndInOne(const Pose2& map_T_start, const PreparedCase& push,
                               const std::function<bool()>& stop) {
  stop_ = &stop;
  tests_left_ = kMostTests;
  last_ = 0;
  const auto ends = sigmaPoints(push.start_outcome, kSpread);
  return std::any_of(ends.begin(), ends.end(), [&](const Pose2& start_T_end) {
    visited_.clear();
    return !canGoOn(map_T_start * start_T_end, push, kPushes);
  });
}

bool DeadEndCheck::mustStop() {
  if (tests_left_ <= 0) return true;
  --tests_left_;
  if (*stop_ && tests_left_ % kTestsUnasked == 0 && (*stop_)()) tests_left_ = 0;
  return tests_left_ == 0;
}

bool DeadEndCheck::canGoOn(const Pose2& map_T_object, const PreparedCase& previous, int pushes) {
  if (pushes == 0 || request_.tolerance.isMet(request_.map_T_goal, map_T_object)) return true;
  if (!visited_.insert(poseCell(map_T_object, kCell_m, kRho_m)).second) return false;
  for (int i = 0; i < case_count_; ++i) {
    if (mustStop()) return true;
    const int index = (last_ + i) % case_count_;
    const PreparedCase& next = cases_(index);
    if (checker_->isSafe(next, map_T_object) &&
        approaches_->canApproachSimply(map_T_object, &previous, next) &&
        canGoOn(map_T_object * next.start_outcome.mean, next, pushes - 1)) {
      last_ = index;
      return true;
    }
  }
  return false;
}

}  // namespace casepush
