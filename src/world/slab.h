#pragma once

#include <cstdint>
#include <vector>

#include "casepush/world/shadow.h"

namespace casepush {

constexpr int kSlices = 64;

/// What a part covers in some of the height slices, in the solid's frame.
struct Slab {
  Shadow shadow;
  std::uint64_t slices = 0;
};

/// Bits of the slices that reach into the open interval (low_m, high_m).
std::uint64_t sliceMask(double low_m, double high_m, double slice_m);

/// A prism is one slab; other parts have one for each slice.
std::vector<Slab> slabs(const ConvexPart& part, double slice_m);

/// Corners of the shadow's axis-aligned bounding box.
void shadowBounds(const Shadow& shadow, Eigen::Vector2d* low_m, Eigen::Vector2d* high_m);

}  // namespace casepush
