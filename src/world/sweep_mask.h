#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "layered_bitmap.h"
#include "swept_shapes.h"

namespace casepush {

/// Bit masks of what a sweep covers at one heading, relative to the cell of its start.
struct SweepMask {
  using Layer = LayeredBitmap::Part;

  int first_column = 0;
  int strips = 0;
  Layer any;                                          ///< Of all classes together.
  std::array<Layer, HeightClasses::kMost> outer{};    ///< For each class: may be covered.
  std::array<Layer, HeightClasses::kMost> certain{};  ///< For each class: certainly covered.
  std::vector<std::uint64_t> words;
};

/// Rasterises shapes turned by `yaw_rad`, valid for headings within +- `half_bin_rad` of it and
/// whatever place the start has in its cell.
SweepMask makeSweepMask(const std::vector<SweptShape>& covering,
                        const std::vector<SweptShape>& covered, int classes, double yaw_rad,
                        double half_bin_rad, double resolution_m);

}  // namespace casepush
