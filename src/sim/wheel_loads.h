#pragma once

#include <Eigen/Core>
#include <vector>

namespace casepush::sim {

/// Shares a load among supports as equal springs below a rigid body would: N = a + b x + c y, with
/// sum N = `total` and sum N p = `moment`. What would pull is lifted off, and the others bear it.
///
/// @param moment  Load times its place [N m].
/// @param loads  Result, by point; left alone if there is none.
/// @return  False if the points lie in a line or are too few.
/// @pre loads.size() == points.size()
bool shareLoad(const std::vector<Eigen::Vector2d>& points, double total,
               const Eigen::Vector2d& moment, std::vector<double>& loads);

}  // namespace casepush::sim
