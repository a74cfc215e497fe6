#pragma once

#include <cstdint>
#include <vector>

#include "patience.h"

namespace casepush {

/// Distance from each cell's centre to the nearest point of the occupied cells' squares, in cells:
/// 0 in an occupied cell, 0.5 beside one. Exact, linear in the number of cells.
///
/// Two passes of lower envelopes of parabolas (Felzenszwalb and Huttenlocher, "Distance Transforms
/// of Sampled Functions", 2012), with the parabolas on the cells' edges instead of their centres.
/// Without any occupied cell all distances are huge. Unfinished once `patience` is over.
std::vector<float> distanceToSquares(const std::vector<std::uint8_t>& occupied, int width,
                                     int height, const Patience& patience = Patience());

}  // namespace casepush
