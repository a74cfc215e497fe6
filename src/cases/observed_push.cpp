#include "casepush/cases/observed_push.h"

#include <utility>

#include "casepush/cases/case_tube.h"

namespace casepush {

ObservedPush observedPush(const PushReport& report, const PushContext& context) {
  ObservedPush push;
  push.start_T_object = report.map_T_start.inverse() * report.map_T_end;
  push.steps = report.recorded.steps;
  push.period_s = report.recorded.period_s;
  push.push_steps = report.recorded.push_steps;
  push.stamp_s = report.end_stamp_s;
  push.context = context;
  return push;
}

std::vector<Pose2> objectPath(const std::vector<CaseStep>& steps) {
  std::vector<Pose2> path;
  path.reserve(steps.size());
  for (const CaseStep& step : steps) {
    path.push_back(step.start_T_object);
  }
  return path;
}

Case withObservation(Case push_case, const Pose2& start_T_object, const std::vector<Pose2>& path,
                     double weight, const CovarianceFloor& floor) {
  const OutcomeStatistics past{push_case.start_outcome, push_case.effective_count};
  const OutcomeStatistics now = adapt(past, start_T_object, weight, floor);
  push_case.start_outcome = now.start_outcome;
  push_case.effective_count = now.effective_count;
  ++push_case.observation_count;
  if (!push_case.tube.empty()) {
    push_case.tube = updateTube(push_case.tube, path, start_T_object, weight, floor);
    push_case.tube.back() = push_case.start_outcome;
  }
  return push_case;
}

bool takesOverTrajectories(const Case& push_case, const ObservedPush& push) {
  return push_case.origin == CaseOrigin::kTransferred && push_case.observation_count == 0 &&
         !push.steps.empty();
}

Case withPush(Case push_case, const ObservedPush& push, double weight,
              const CovarianceFloor& floor) {
  const bool takes_over = takesOverTrajectories(push_case, push);
  Case updated = withObservation(std::move(push_case), push.start_T_object, objectPath(push.steps),
                                 weight, floor);
  if (takes_over) {
    updated.steps = push.steps;
    updated.period_s = push.period_s;
    updated.push_steps = push.push_steps;
    updated.tube = tubeFromOutcome(updated.steps, updated.start_outcome, floor);
  }
  return updated;
}

}  // namespace casepush
