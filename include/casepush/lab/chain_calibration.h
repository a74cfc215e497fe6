#pragma once

#include <vector>

#include "casepush/model/push_report.h"

namespace casepush {

/// How often chains of pushes ended where their cases had said, with the scatter compounded.
struct ChainCalibration {
  int pushes = 0;  ///< Of each chain.
  int chains = 0;
  double inside_50 = 0.0;       ///< Share within the region that should hold 50 %,
  double inside_90 = 0.0;       ///< 90 %,
  double inside_95 = 0.0;       ///< 95 % of all.
  double position_rms_m = 0.0;  ///< Deviation from the mean.
  double yaw_rms_rad = 0.0;
};

/// Of all chains of up to `most_pushes` consecutive pushes, overlapping ones too: each is compared
/// with what was expected of its pushes, chained from where the first one began (compound()), by
/// its squared Mahalanobis distance. Chains end before a push that was not made as planned, or of
/// no case. One row for each length that occurs.
/// @param tasks  The reports of each task, in order.
std::vector<ChainCalibration> calibrateChains(const std::vector<std::vector<PushReport>>& tasks,
                                              int most_pushes);

}  // namespace casepush
