#pragma once

#include <vector>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/model/case.h"

namespace casepush {

/// Mean object trajectory of a case and covariance along it (see Case::tube), the paper's first
/// future-work item. Statistics are those of eq. 1, 2 and 7-9, at each step instead of at the end
/// only; the practices are aligned with the mean trajectory by dynamic time warping.

/// The tube of a case of which nothing but the first trial and the outcome is known: the recorded
/// trajectory, bent so that it ends at the mean outcome; the standard deviation grows with the way
/// travelled.
/// @pre `steps` is not empty.
std::vector<PoseGaussian> tubeFromOutcome(const std::vector<CaseStep>& steps,
                                          const PoseGaussian& start_outcome,
                                          const CovarianceFloor& floor);

/// Adds one observed object trajectory, the past counting `weight` observations.
/// @param path  start_T_object over the push, in any timing; the last pose is at rest. If it is
///   empty, only `start_T_object` is known: the mean trajectory bent to end there.
/// @pre `tube` is not empty, weight >= 0.
std::vector<PoseGaussian> updateTube(const std::vector<PoseGaussian>& tube,
                                     const std::vector<Pose2>& path, const Pose2& start_T_object,
                                     double weight, const CovarianceFloor& floor);

}  // namespace casepush
