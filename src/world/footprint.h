#pragma once

#include <cstdint>
#include <vector>

#include "casepush/world/shadow.h"
#include "slab.h"

namespace casepush {

/// Cells that a solid may reach into, relative to the cell of its origin, for each heading bin.
///
/// Conservative: they cover the solid, grown by the margin, wherever in its cell the origin lies
/// and whichever heading within the bin it has.
class Footprint {
 public:
  static constexpr int kHeadings = 128;

  /// What may be covered in one column.
  struct Entry {
    std::int32_t dx;
    std::int32_t dy;
    std::uint64_t slices;
  };

  Footprint(const Solid& solid, double margin_m, double resolution_m, double slice_m);

  const std::vector<Entry>& entries(double yaw_rad) const;

  const std::vector<ConvexPart>& parts() const { return parts_; }
  /// Around each part, grown by the margin.
  const std::vector<BoundingDisc>& discs() const { return discs_; }
  double margin() const { return margin_m_; }
  double resolution() const { return resolution_m_; }
  double reach() const { return reach_m_; }        ///< Circumscribed radius, with margin [m].
  int reachCells() const { return reach_cells_; }  ///< Bound of |dx| and |dy|.

 private:
  std::vector<Entry> rasterise(double yaw_rad,
                               const std::vector<std::vector<Slab>>& part_slabs) const;

  std::vector<ConvexPart> parts_;
  std::vector<BoundingDisc> discs_;
  double margin_m_;
  double resolution_m_;
  double reach_m_ = 0.0;
  int reach_cells_ = 0;
  std::vector<std::vector<Entry>> entries_;
};

}  // namespace casepush
