#include "casepush/lab/mean_interval.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "casepush/common/check.h"
#include "casepush/common/random.h"

namespace casepush {
namespace {

/// Student's t for 95 % (two-sided) by degrees of freedom, from 1.
constexpr std::array<double, 30> kStudent = {
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
    2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
    2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};

}  // namespace

MeanInterval meanInterval(const std::vector<double>& values) {
  CASEPUSH_CHECK(!values.empty(), "no values");
  const double n = static_cast<double>(values.size());
  MeanInterval interval;
  interval.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double half = 0.0;
  if (values.size() > 1) {
    double squares = 0.0;
    for (const double value : values) {
      squares += (value - interval.mean) * (value - interval.mean);
    }
    const double student = kStudent[std::min(values.size() - 2, kStudent.size() - 1)];
    half = student * std::sqrt(squares / (n - 1.0) / n);
  }
  interval.low = interval.mean - half;
  interval.high = interval.mean + half;
  return interval;
}

MeanInterval bootstrapInterval(const std::vector<double>& values, std::uint64_t seed) {
  CASEPUSH_CHECK(!values.empty(), "no values");
  constexpr int kResamples = 4000;
  Random random = Random::stream(seed, "bootstrap");
  const double n = static_cast<double>(values.size());
  std::vector<double> means(kResamples, 0.0);
  for (double& mean : means) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean += values[random.below(values.size())] / n;
    }
  }
  std::sort(means.begin(), means.end());
  constexpr int kTail = kResamples / 40;  // 2.5 %
  return {std::accumulate(values.begin(), values.end(), 0.0) / n, means[kTail],
          means[kResamples - 1 - kTail]};
}

}  // namespace casepush
