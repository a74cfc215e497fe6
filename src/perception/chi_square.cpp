#include "chi_square.h"

#include <algorithm>
#include <cmath>

namespace casepush {

double chiSquareTail3(double squared_distance) {
  const double x = std::max(0.0, squared_distance);
  return std::erfc(std::sqrt(0.5 * x)) + std::sqrt(2.0 * x / M_PI) * std::exp(-0.5 * x);
}

}  // namespace casepush
