#include "casepush/cases/case_tube.h"

#include "casepush/cases/trajectory_alignment.h"
#include "casepush/common/check.h"

namespace casepush {
namespace {

// The trajectory with its end moved to `end`: the deviation grows with the way travelled.
std::vector<Pose2> bentTo(const std::vector<Pose2>& trajectory, const Pose2& end,
                          const std::vector<double>& shares) {
  const Eigen::Vector3d deviation = logSe2(trajectory.back().inverse() * end);
  std::vector<Pose2> bent;
  bent.reserve(trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    bent.push_back(trajectory[i] * expSe2(shares[i] * deviation));
  }
  bent.back() = end;
  return bent;
}

std::vector<Pose2> meansOf(const std::vector<PoseGaussian>& tube) {
  std::vector<Pose2> means;
  means.reserve(tube.size());
  for (const PoseGaussian& step : tube) {
    means.push_back(step.mean);
  }
  return means;
}

}  // namespace

std::vector<PoseGaussian> tubeFromOutcome(const std::vector<CaseStep>& steps,
                                          const PoseGaussian& start_outcome,
                                          const CovarianceFloor& floor) {
  CASEPUSH_CHECK(!steps.empty(), "no steps");
  std::vector<Pose2> recorded;
  recorded.reserve(steps.size());
  for (const CaseStep& step : steps) {
    recorded.push_back(step.start_T_object);
  }
  const std::vector<double> shares = travelledShares(recorded);
  const std::vector<Pose2> means = bentTo(recorded, start_outcome.mean, shares);
  std::vector<PoseGaussian> tube;
  tube.reserve(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    tube.push_back(
        {means[i], raiseToFloor(shares[i] * shares[i] * start_outcome.covariance, floor)});
  }
  tube.back() = start_outcome;
  return tube;
}

std::vector<PoseGaussian> updateTube(const std::vector<PoseGaussian>& tube,
                                     const std::vector<Pose2>& path, const Pose2& start_T_object,
                                     double weight, const CovarianceFloor& floor) {
  CASEPUSH_CHECK(!tube.empty(), "no tube");
  const std::vector<Pose2> means = meansOf(tube);
  std::vector<Pose2> aligned = path.empty() ? bentTo(means, start_T_object, travelledShares(means))
                                            : posesAt(path, alignTrajectories(means, path).places);
  aligned.back() = start_T_object;
  std::vector<PoseGaussian> updated;
  updated.reserve(tube.size());
  for (std::size_t i = 0; i < tube.size(); ++i) {
    updated.push_back(addObservation({tube[i], weight}, aligned[i], floor).start_outcome);
  }
  return updated;
}

}  // namespace casepush
