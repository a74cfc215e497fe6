#include "casepush/common/normal_samples.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "casepush/common/check.h"
#include "casepush/common/random.h"

namespace casepush {
namespace {

/// The digits of `index` mirrored at the point, in [0, 1).
double radicalInverse(int index, int base) {
  double result = 0.0;
  double digit = 1.0 / base;
  for (; index > 0; index /= base) {
    result += digit * (index % base);
    digit /= base;
  }
  return result;
}

double normalQuantile(double probability) {
  constexpr double kSmallest = 1e-9;  // No deviate beyond six standard deviations.
  const double inside = std::clamp(probability, kSmallest, 1.0 - kSmallest);
  return M_SQRT2 * boost::math::erf_inv(2.0 * inside - 1.0);
}

}  // namespace

std::vector<Eigen::Vector3d> normalSamples(int count, std::uint64_t seed) {
  CASEPUSH_CHECK(count > 0, count << " samples");
  constexpr int kBases[] = {2, 3, 5};
  Random random = Random::stream(seed, "normal_samples");
  Eigen::Vector3d shift;
  for (int axis = 0; axis < 3; ++axis) {
    shift(axis) = random.uniform(0.0, 1.0);
  }
  std::vector<Eigen::Vector3d> samples(count);
  for (int i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double even = radicalInverse(i + 1, kBases[axis]) + shift(axis);
      samples[i](axis) = normalQuantile(even - std::floor(even));
    }
  }
  return samples;
}

}  // namespace casepush
