#pragma once

#include <cstdint>
#include <functional>
#include <unordered_set>

#include "casepush/model/push_plan.h"
#include "casepush/planning/push_checker.h"
#include "plan_search.h"

namespace casepush {

/// Tells pushes after which the object may stand where it cannot be pushed any more.
///
/// A plan needs its pushes to fit from their mean start poses only, and an object that came to rest
/// a centimetre beside one may stand where no case can be applied: too near to a wall to be pushed
/// from there, say. So each pose that a push may end in, the mean of its outcome and the sigma
/// points twice the standard deviation away, must have a way on: eight cases that can be applied
/// one after the other to poses that differ (each safe at its own sigma points, and the robot gets
/// to its start), or fewer that lead to the goal. A depth-first search looks for them, which comes
/// to no pose twice and gives up after many tests, so that it may see a dead end where there is
/// none, and none where there is one.
class DeadEndCheck {
 public:
  /// Cases by index, prepared when they are first asked for.
  using GetCase = std::function<const PreparedCase&(int)>;

  /// @param request  Whose goal counts. All must outlive it.
  DeadEndCheck(const PlanRequest& request, int case_count, GetCase cases, PushChecker* checker,
               ApproachVerifier* approaches);

  /// @param push  That is begun with the object at rest at `map_T_start`.
  /// @param stop  Asked often; once it says true, the answer is no. Empty: never. So is the answer
  ///              if many tests were not enough to tell.
  bool mayEndInOne(const Pose2& map_T_start, const PreparedCase& push,
                   const std::function<bool()>& stop = {});

 private:
  /// @param pushes  So many more, from where `previous` left robot and object.
  bool canGoOn(const Pose2& map_T_object, const PreparedCase& previous, int pushes);

  const PlanRequest& request_;
  int case_count_;
  GetCase cases_;
  PushChecker* checker_;
  ApproachVerifier* approaches_;
  bool mustStop();

  const std::function<bool()>* stop_ = nullptr;  // Of the present call.
  int tests_left_ = 0;
  std::unordered_set<std::uint64_t> visited_;  // Cells of poses that were pushed on from.
  int last_ = 0;  // The case that was found last: mostly it fits the next time, too.
};

}  // namespace casepush
