#pragma once

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

  bool contains(int x, int y) const { return x >= x0 && x <= x1 && y >= y0 && y <= y1; }
};

}  // namespace casepush
