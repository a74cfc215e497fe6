#include "casepush/planning/clearance_field.h"

#include <algorithm>
#include <cmath>

#include "distance_transform.h"

namespace casepush {

ClearanceField::ClearanceField(const CollisionChecker::Columns& columns)
    : origin_m_(columns.origin_m),
      cells_per_m_(1.0 / columns.resolution_m),
      width_(columns.width),
      height_(columns.height) {
  std::vector<std::uint8_t> occupied(columns.bits.size());
  std::transform(columns.bits.begin(), columns.bits.end(), occupied.begin(),
                 [](std::uint64_t bits) { return bits == 0 ? 0 : 1; });
  clearance_m_ = distanceToSquares(occupied, width_, height_);
  const auto cell_m = static_cast<float>(columns.resolution_m);
  // From the cell's centre; a point of the cell may be half a diagonal nearer.
  const float half_diagonal_m = std::sqrt(0.5F) * cell_m;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto border = static_cast<float>(std::min({x, y, width_ - 1 - x, height_ - 1 - y}));
      float& value = clearance_m_[static_cast<std::size_t>(y) * width_ + x];
      value = std::min(value * cell_m - half_diagonal_m, border * cell_m);
    }
  }
}

}  // namespace casepush
