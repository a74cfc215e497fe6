#pragma once

#include <vector>

namespace casepush {

/// The value that a share of the values do not exceed, interpolated between neighbours: 0.5 gives
/// the median, 1 the largest. 0 without values.
/// @pre 0 <= share <= 1.
double quantile(std::vector<double> values, double share);

}  // namespace casepush
