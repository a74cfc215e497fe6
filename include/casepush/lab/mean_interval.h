#pragma once

#include <vector>

namespace casepush {

/// Mean of a sample with its 95 % confidence interval (Student's t).
struct MeanInterval {
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// For one value the interval is that value. @pre values is not empty.
MeanInterval meanInterval(const std::vector<double>& values);

}  // namespace casepush
