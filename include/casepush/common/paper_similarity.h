#pragma once

#include "casepush/common/pose2.h"

namespace casepush {

/// Similarity of two poses by paper eq. 3: d_max / dist * cos(dyaw).
///
/// dist is floored at 1 mm; past 90 degrees, where the printed formula changes sign and prefers
/// what is farther away, the similarity is 0.
/// @param max_distance_m  d_max, the largest distance in the environment.
double paperSimilarity(const Pose2& a, const Pose2& b, double max_distance_m);

}  // namespace casepush
