#include "casepush/common/halton.h"

namespace casepush {
namespace {

/// Radical inverse: the digits of `i` in a base, mirrored at the point.
double radicalInverse(int i, int base) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (; i > 0; i /= base) {
    value += digit * (i % base);
    digit /= base;
  }
  return value;
}

}  // namespace

Eigen::Vector3d halton(int i) {
  return {radicalInverse(i, 2), radicalInverse(i, 3), radicalInverse(i, 5)};
}

}  // namespace casepush
