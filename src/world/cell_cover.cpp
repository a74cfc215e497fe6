#include "cell_cover.h"

#include <cmath>

#include "slab.h"

namespace casepush {

int cellBelow(double coordinate_m, double resolution_m) {
  return static_cast<int>(std::floor(coordinate_m / resolution_m));
}

Eigen::Vector3f cellCentre(int ix, int iy, int iz, double resolution_m) {
  return (Eigen::Vector3d(ix + 0.5, iy + 0.5, iz + 0.5) * resolution_m).cast<float>();
}

void visitCoveredCells(const Shadow& map_shadow, double resolution_m,
                       const std::function<void(int ix, int iy)>& visit) {
  if (map_shadow.empty()) return;
  Eigen::Vector2d low;
  Eigen::Vector2d high;
  shadowBounds(map_shadow, &low, &high);
  for (int ix = cellBelow(low.x(), resolution_m); ix * resolution_m < high.x(); ++ix) {
    for (int iy = cellBelow(low.y(), resolution_m); iy * resolution_m < high.y(); ++iy) {
      const Eigen::Vector2d corner = Eigen::Vector2d(ix, iy) * resolution_m;
      if (closerThan(map_shadow, rectangle(corner, corner.array() + resolution_m), 0.0)) {
        visit(ix, iy);
      }
    }
  }
}

void addFloorRim(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m, double resolution_m,
                 std::vector<Eigen::Vector3f>* points) {
  const auto add = [&](int ix, int iy) { points->push_back(cellCentre(ix, iy, -1, resolution_m)); };
  const int left = cellBelow(min_m.x() + kSkin_m, resolution_m);
  const int right = cellBelow(max_m.x() - kSkin_m, resolution_m);
  const int bottom = cellBelow(min_m.y() + kSkin_m, resolution_m);
  const int top = cellBelow(max_m.y() - kSkin_m, resolution_m);
  for (int ix = left; ix <= right; ++ix) {
    add(ix, bottom);
    add(ix, top);
  }
  for (int iy = bottom + 1; iy < top; ++iy) {
    add(left, iy);
    add(right, iy);
  }
}

}  // namespace casepush
