#include "footprint.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "casepush/common/check.h"
#include "mask_canvas.h"

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
  std::vector<std::vector<Slab>> part_slabs;
  for (const ConvexPart& part : parts_) part_slabs.push_back(slabs(part, slice_m));
  for (int bin = 0; bin < kHeadings; ++bin) {
    entries_.push_back(rasterise(bin * kBin_rad, part_slabs));
  }
}

const std::vector<Footprint::Entry>& Footprint::entries(double yaw_rad) const {
  const int bin = static_cast<int>(std::floor(yaw_rad / kBin_rad + 0.5));
  return entries_[static_cast<std::size_t>(bin) & (kHeadings - 1)];
}

std::vector<Footprint::Entry> Footprint::rasterise(
    double yaw_rad, const std::vector<std::vector<Slab>>& part_slabs) const {
  const int side = 2 * reach_cells_ + 1;
  std::vector<std::uint64_t> grid(static_cast<std::size_t>(side) * side, 0);
  MaskPen pen(yaw_rad, kBin_rad / 2.0, resolution_m_);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    // No point of the part moves further than this within half a heading bin.
    const double grown_m = margin_m_ + 2.0 * parts_[i].reach() * std::sin(kBin_rad / 4.0);
    for (const Slab& slab : part_slabs[i]) {
      for (const MaskPen::Row& row : pen.cover(slab.shadow, grown_m)) {
        if (std::abs(row.y) > reach_cells_) continue;
        const int last = std::min(row.last, reach_cells_);
        for (int dx = std::max(row.first, -reach_cells_); dx <= last; ++dx) {
          grid[(row.y + reach_cells_) * side + dx + reach_cells_] |= slab.slices;
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
