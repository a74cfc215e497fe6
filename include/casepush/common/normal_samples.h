#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace casepush {

/// Points that stand for a standard normal distribution in three dimensions: evenly spread, so that
/// averages over them are nearer to the truth than averages over as many random points.
///
/// A Halton sequence (bases 2, 3 and 5), shifted by what the seed says (Cranley and Patterson
/// 1976), taken to normal deviates.
/// @pre count > 0.
std::vector<Eigen::Vector3d> normalSamples(int count, std::uint64_t seed);

}  // namespace casepush
