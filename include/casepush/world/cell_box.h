#pragma once

#include <algorithm>

namespace casepush {

/// A cell, or an image's size in cells.
struct CellIndex {
  int x = 0;
  int y = 0;
};

/// Bounds in cells, all inclusive.
struct CellBox {
  int x0 = 0;
  int x1 = -1;
  int y0 = 0;
  int y1 = -1;

  int width() const { return x1 - x0 + 1; }
  int height() const { return y1 - y0 + 1; }
  bool empty() const { return x0 > x1 || y0 > y1; }
  bool contains(int x, int y) const { return x >= x0 && x <= x1 && y >= y0 && y <= y1; }

  /// Grown by `cells` on all sides, but not beyond an image of that size.
  CellBox grown(int cells, const CellIndex& size) const {
    return {std::max(0, x0 - cells), std::min(size.x - 1, x1 + cells), std::max(0, y0 - cells),
            std::min(size.y - 1, y1 + cells)};
  }
};

}  // namespace casepush
