#pragma once

#include <Eigen/Core>

namespace casepush {

/// The i-th point of Halton's sequence in three dimensions (bases 2, 3 and 5), in [0, 1)^3: evenly
/// spread, however many are taken. @pre i >= 0; the 0th is the origin.
Eigen::Vector3d halton(int i);

}  // namespace casepush
