#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "patience.h"

namespace casepush {

/// Halves of the lengths of a way through a cell, in whole numbers: a step takes those of both its
/// cells. 0 where there is no way.
struct HalfSteps {
  std::uint8_t straight = 0;
  std::uint8_t diagonal = 0;

  /// From a cell to its neighbour; 0 if there is no way.
  static int step(const HalfSteps& from, const HalfSteps& to, bool is_diagonal) {
    if (to.straight == 0) return 0;
    return is_diagonal ? from.diagonal + to.diagonal : from.straight + to.straight;
  }
};

/// Lengths of the ways from a few cells, far from one another, to all cells of a room. They tell
/// how long the way between any two is at least (ALT: Goldberg and Harrelson 2005), also where
/// obstacles make it longer.
class RoomLandmarks {
 public:
  RoomLandmarks() = default;

  /// @param half_steps  Row by row, with a rim of one cell without ways around the room.
  /// @param longest_step  No step takes more.
  /// @param patience  Once it is over, the lengths are of no use.
  RoomLandmarks(const std::vector<HalfSteps>& half_steps, int stride, int longest_step,
                const Patience& patience);

  bool empty() const { return lengths_.empty(); }

  /// Between a cell where there is a way and any other. A step to a neighbour changes it by no more
  /// than the step takes.
  int between(int cell, int other) const {
    const Lengths more = lengths_[cell] - lengths_[other];
    const Lengths apart = more > 0 ? more : -more;
    return std::max(std::max(apart[0], apart[1]), std::max(apart[2], apart[3]));
  }

 private:
  static constexpr int kCount = 4;
  static constexpr int kNoWay = 1 << 29;
  using Lengths [[gnu::vector_size(kCount * sizeof(int))]] = int;  // for the processor's vectors

  std::vector<Lengths> lengths_;  // of each cell, from each landmark
};

}  // namespace casepush
