#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "casepush/world/shadow.h"

namespace casepush {

/// Shapes are shrunk by this at each side, lest a face that lies on a cell's border fills both
/// cells.
constexpr double kSkin_m = 0.001;

/// Index of the cell that a coordinate lies in.
int cellBelow(double coordinate_m, double resolution_m);

Eigen::Vector3f cellCentre(int ix, int iy, int iz, double resolution_m);

/// Visits all cells of the map's grid, seen from above, that the shadow reaches into.
void visitCoveredCells(const Shadow& map_shadow, double resolution_m,
                       const std::function<void(int ix, int iy)>& visit);

/// The floor along a rectangle, one layer of cells below z = 0: no obstacle, but known.
void addFloorRim(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double resolution_m,
                 std::vector<Eigen::Vector3f>* points);

}  // namespace casepush
