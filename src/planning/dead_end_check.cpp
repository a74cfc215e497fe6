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
// Where so many did not fit it is left open whether others do.
constexpr int kMostTests = 3000;

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
    visited_.clear();
    return !canGoOn(map_T_start * start_T_end, push, kPushes);
  });
}

bool DeadEndCheck::canGoOn(const Pose2& map_T_object, const PreparedCase& previous, int pushes) {
  if (pushes == 0 || request_.tolerance.isMet(request_.map_T_goal, map_T_object)) return true;
  if (!visited_.insert(poseCell(map_T_object, kCell_m, kRho_m)).second) return false;
  for (int i = 0; i < case_count_; ++i) {
    if (--tests_left_ < 0) return true;
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
