#include "slab.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace casepush {
namespace {

int sliceIndex(double z_m, double slice_m) {
  return static_cast<int>(std::clamp(std::floor(z_m / slice_m), 0.0, kSlices - 1.0));
}

}  // namespace

std::uint64_t sliceMask(double low_m, double high_m, double slice_m) {
  const int first = sliceIndex(low_m + kContactTolerance_m, slice_m);
  const int last = std::max(first, sliceIndex(high_m - kContactTolerance_m, slice_m));
  return (~std::uint64_t{0} << first) & (~std::uint64_t{0} >> (kSlices - 1 - last));
}

std::vector<Slab> slabs(const ConvexPart& part, double slice_m) {
  const HeightRange heights = part.heights();
  if (part.isPrism()) {
    return {{part.shadow(), sliceMask(heights.low_m, heights.high_m, slice_m)}};
  }
  std::vector<Slab> result;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (int slice = 0; slice < kSlices; ++slice) {
    const double low = slice == 0 ? -kInfinity : slice * slice_m;
    const double high = slice == kSlices - 1 ? kInfinity : (slice + 1) * slice_m;
    const Shadow shadow = part.shadow(std::max(low, heights.low_m), std::min(high, heights.high_m));
    if (!shadow.empty()) result.push_back({shadow, std::uint64_t{1} << slice});
  }
  return result;
}

void shadowBounds(const Shadow& shadow, Eigen::Vector2d* low_m, Eigen::Vector2d* high_m) {
  *low_m = *high_m = shadow.points[0];
  for (int i = 1; i < shadow.count; ++i) {
    *low_m = low_m->cwiseMin(shadow.points[i]);
    *high_m = high_m->cwiseMax(shadow.points[i]);
  }
  low_m->array() -= shadow.radius_m;
  high_m->array() += shadow.radius_m;
}

}  // namespace casepush
