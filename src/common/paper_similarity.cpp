#include "casepush/common/paper_similarity.h"

#include <algorithm>
#include <cmath>

namespace casepush {

double paperSimilarity(const Pose2& a, const Pose2& b, double max_distance_m) {
  constexpr double kClosest_m = 1e-3;
  const double cosine = std::max(0.0, std::cos(yawDifference(a, b)));
  return max_distance_m / std::max(kClosest_m, distance(a, b)) * cosine;
}

}  // namespace casepush
