#pragma once

#include <cstdint>
#include <vector>

namespace casepush {

/// Mean of a sample with its 95 % confidence interval.
struct MeanInterval {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// By Student's t. For one value the interval is that value. @pre values is not empty.
MeanInterval meanInterval(const std::vector<double>& values);

/// The interval by the percentiles of 4000 resamples (bootstrap), for whatever distribution.
/// @pre values is not empty.
MeanInterval bootstrapInterval(const std::vector<double>& values, std::uint64_t seed);

/// Mean of `above` over mean of `below` with its 95 % interval, by resampling pairs as above.
/// @pre As many of both, at least one; all of `below` are positive.
MeanInterval bootstrapRatio(const std::vector<double>& above, const std::vector<double>& below,
                            std::uint64_t seed);

}  // namespace casepush
