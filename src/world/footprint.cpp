#include "footprint.h"

#include <algorithm>
#include <cmath>

#include "casepush/common/check.h"
#include "slab.h"

namespace casepush {
namespace {

constexpr double kBin_rad = 2.0 * M_PI / Footprint::kHeadings;

}  // namespace

Footprint::Footprint(const Solid& solid, double margin_m, double resolution_m, double slice_m)
    : parts_(convexParts(solid)), margin_m_(margin_m), resolution_m_(resolution_m) {
  CASEPUSH_CHECK(!solid.empty() && margin_m >= 0.0, solid.size() << " parts, margin " << margin_m);
  for (const ConvexPart& part : parts_) {
    reach_m_ = std::max(reach_m_, part.reach());
    discs_.push_back({part.disc().centre_m, part.disc().radius_m + margin_m});
  }
  reach_m_ += margin_m;
  reach_cells_ = static_cast<int>(std::ceil(reach_m_ * (1.0 + kBin_rad) / resolution_m)) + 1;
  for (int bin = 0; bin < kHeadings; ++bin) entries_.push_back(rasterise(bin * kBin_rad, slice_m));
}

const std::vector<Footprint::Entry>& Footprint::entries(double yaw_rad) const {
  const int bin = static_cast<int>(std::floor(yaw_rad / kBin_rad + 0.5));
  return entries_[static_cast<std::size_t>(bin) & (kHeadings - 1)];
}

std::vector<Footprint::Entry> Footprint::rasterise(double yaw_rad, double slice_m) const {
  const int side = 2 * reach_cells_ + 1;
  std::vector<std::uint64_t> grid(static_cast<std::size_t>(side) * side, 0);
  const auto cell = [&](double coordinate_m) {
    const int index = static_cast<int>(std::floor(coordinate_m / resolution_m_));
    return std::clamp(index, -reach_cells_, reach_cells_);
  };
  for (const ConvexPart& part : parts_) {
    // No point of the part moves further than this within half a heading bin.
    const double grown_m = margin_m_ + 2.0 * part.reach() * std::sin(kBin_rad / 4.0);
    for (const Slab& slab : slabs(part, slice_m)) {
      const Shadow shadow = transformed({0.0, 0.0, yaw_rad}, slab.shadow);
      Eigen::Vector2d low;
      Eigen::Vector2d high;
      shadowBounds(shadow, &low, &high);
      for (int dy = cell(low.y() - grown_m); dy <= cell(high.y() + grown_m) + 1; ++dy) {
        for (int dx = cell(low.x() - grown_m); dx <= cell(high.x() + grown_m) + 1; ++dx) {
          if (dx > reach_cells_ || dy > reach_cells_) continue;
          // The origin lies anywhere in its cell, so the cell is seen anywhere in two by two.
          const Eigen::Vector2d corner = Eigen::Vector2d(dx, dy) * resolution_m_;
          const Shadow square =
              rectangle(corner.array() - resolution_m_, corner.array() + resolution_m_);
          if (!closerThan(shadow, square, grown_m)) continue;
          grid[(dy + reach_cells_) * side + dx + reach_cells_] |= slab.slices;
        }
      }
    }
  }
  std::vector<Entry> entries;
  for (int i = 0; i < side * side; ++i) {
    if (grid[i] == 0) continue;
    entries.push_back({i % side - reach_cells_, i / side - reach_cells_, grid[i]});
  }
  return entries;
}

}  // namespace casepush
