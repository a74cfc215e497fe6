#pragma once

#include <cstdint>
#include <vector>

#include "swept_shapes.h"

namespace casepush {

/// Bit masks of what a sweep covers at one heading, relative to the cell of its start.
struct SweepMask {
  /// A stack of words, see LayeredBitmap::overlaps().
  struct Layer {
    int first_row = 0;
    int rows = 0;            ///< A multiple of 4; 0: empty.
    std::size_t offset = 0;  ///< Into words.
  };

  int first_column = 0;
  int strips = 0;
  Layer any;                   ///< Of all classes together.
  std::vector<Layer> outer;    ///< For each height class: may be covered.
  std::vector<Layer> certain;  ///< For each height class: certainly covered.
  std::vector<std::uint64_t> words;
};

/// Rasterises shapes turned by `yaw_rad`, valid for headings within +- `half_bin_rad` of it and
/// whatever place the start has in its cell.
SweepMask makeSweepMask(const std::vector<SweptShape>& covering,
                        const std::vector<SweptShape>& covered, int classes, double yaw_rad,
                        double half_bin_rad, double resolution_m);

}  // namespace casepush
