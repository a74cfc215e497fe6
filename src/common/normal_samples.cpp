#include "casepush/common/normal_samples.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "casepush/common/check.h"
#include "casepush/common/halton.h"
#include "casepush/common/random.h"

namespace casepush {
namespace {

double normalQuantile(double probability) {
  constexpr double kSmallest = 1e-9;  // No deviate beyond six standard deviations.
  const double inside = std::clamp(probability, kSmallest, 1.0 - kSmallest);
  return M_SQRT2 * boost::math::erf_inv(2.0 * inside - 1.0);
}

}  // namespace

std::vector<Eigen::Vector3d> normalSamples(int count, std::uint64_t seed) {
  CASEPUSH_CHECK(count > 0, count << " samples");
  Random random = Random::stream(seed, "normal_samples");
  Eigen::Vector3d shift;
  for (int axis = 0; axis < 3; ++axis) {
    shift(axis) = random.uniform(0.0, 1.0);
  }
  std::vector<Eigen::Vector3d> samples(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d shifted = halton(i + 1) + shift;
    for (int axis = 0; axis < 3; ++axis) {
      const double even = shifted(axis);
      samples[i](axis) = normalQuantile(even - std::floor(even));
    }
  }
  return samples;
}

}  // namespace casepush
