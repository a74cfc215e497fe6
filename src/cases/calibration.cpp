#include "casepush/cases/calibration.h"

namespace casepush {

std::vector<LeftOutTest> leaveOneOut(const std::vector<Pose2>& outcomes,
                                     const CovarianceFloor& floor, double alpha) {
  std::vector<LeftOutTest> tests;
  tests.reserve(outcomes.size());
  for (std::size_t left_out = 0; left_out < outcomes.size(); ++left_out) {
    OutcomeStatistics others;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (i != left_out) {
        others = addObservation(others, outcomes[i], floor);
      }
    }
    tests.push_back({testPrediction(others, outcomes[left_out], alpha),
                     testPlugIn(others, outcomes[left_out], alpha)});
  }
  return tests;
}

}  // namespace casepush
