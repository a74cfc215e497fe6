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
  return bootstrapRatio(values, std::vector<double>(values.size(), 1.0), seed);
}

MeanInterval bootstrapRatio(const std::vector<double>& above, const std::vector<double>& below,
                            std::uint64_t seed) {
  CASEPUSH_CHECK(!above.empty() && above.size() == below.size(),
                 above.size() << " and " << below.size() << " values");
  constexpr int kResamples = 4000;
  Random random = Random::stream(seed, "bootstrap");
  std::vector<double> ratios;
  for (int k = 0; k < kResamples; ++k) {
    double sum_above = 0.0, sum_below = 0.0;
    for (std::size_t i = 0; i < above.size(); ++i) {
      const auto drawn = random.below(above.size());
      sum_above += above[drawn];
      sum_below += below[drawn];
    }
    ratios.push_back(sum_above / sum_below);
  }
  std::sort(ratios.begin(), ratios.end());
  constexpr int kTail = kResamples / 40;  // 2.5 %
  return {std::accumulate(above.begin(), above.end(), 0.0) /
              std::accumulate(below.begin(), below.end(), 0.0),
          ratios[kTail], ratios[kResamples - 1 - kTail]};
}

}  // namespace casepush
