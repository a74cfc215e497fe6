#pragma once

#include <optional>
#include <vector>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/model/case.h"
#include "casepush/model/push_report.h"

namespace casepush {

/// One finished push of a known case.
struct ObservedPush {
  Pose2 start_T_object;           ///< At rest.
  std::vector<CaseStep> steps;    ///< As recorded; empty if only the resting pose is known.
  double period_s = 0.1;          ///< Between steps.
  int push_steps = 0;             ///< As Case::push_steps; 0 without steps.
  std::optional<double> stamp_s;  ///< ROS time at rest, simulated in a simulation; if known.
  PushContext context;
};

/// What a report says about the case that was pushed.
ObservedPush observedPush(const PushReport& report, const PushContext& context = {});

/// start_T_object of all steps.
std::vector<Pose2> objectPath(const std::vector<CaseStep>& steps);

/// The case after one more push, the past counting `weight` observations: eq. 1, 2 if that is the
/// effective count, eq. 7-9 otherwise. Outcome and tube, if there is one, are updated.
/// @param path  Trajectory of the object; empty if only the resting pose is known.
/// @throws InputError as addObservation.
Case withObservation(Case push_case, const Pose2& start_T_object, const std::vector<Pose2>& path,
                     double weight, const CovarianceFloor& floor);

/// True if the push is the first one of its own of a transferred case, whose trajectories were
/// seen with another object: the case then takes over those of the push.
bool takesOverTrajectories(const Case& push_case, const ObservedPush& push);

/// withObservation, and the trajectories if they are to be taken over.
Case withPush(Case push_case, const ObservedPush& push, double weight,
              const CovarianceFloor& floor);

}  // namespace casepush
