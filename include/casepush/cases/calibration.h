#pragma once

#include <vector>

#include "casepush/cases/outcome_statistics.h"

namespace casepush {

/// How well all other observations of a case predict one.
struct LeftOutTest {
  PredictionTest hotelling;
  PredictionTest plug_in;  ///< See testPlugIn.
};

/// Tests each outcome against the statistics of all others, added in their order by eq. 1, 2. If
/// pushes scatter as a Gaussian, Hotelling's p-values are uniform on [0, 1].
/// @return One for each outcome; untested (p = 1) if there are no others.
/// @throws InputError as addObservation.
std::vector<LeftOutTest> leaveOneOut(const std::vector<Pose2>& outcomes,
                                     const CovarianceFloor& floor, double alpha);

}  // namespace casepush
