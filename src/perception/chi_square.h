#pragma once

namespace casepush {

/// Probability that a chi-square variable with 3 degrees of freedom exceeds `squared_distance`.
double chiSquareTail3(double squared_distance);

}  // namespace casepush
