#pragma once

#include <array>
#include <cstdint>

#include "casepush/world/cell_box.h"
#include "layered_bitmap.h"

namespace casepush {

/// Where a cell lies in an image of that size once it is turned clockwise by some quarters.
inline CellIndex turned(CellIndex cell, CellIndex size, int quarter) {
  switch (quarter) {
    case 1:
      return {cell.y, size.x - 1 - cell.x};
    case 2:
      return {size.x - 1 - cell.x, size.y - 1 - cell.y};
    case 3:
      return {size.y - 1 - cell.y, cell.x};
    default:
      return cell;
  }
}

/// An image, and the same turned clockwise by one, two and three quarters: a mask for a heading
/// serves the headings a quarter turn apart as well, on another image.
class TurnedBitmaps {
 public:
  static constexpr int kQuarters = 4;

  TurnedBitmaps() = default;
  TurnedBitmaps(int layers, int width, int height, int border) : size_{width, height} {
    for (int q = 0; q < kQuarters; ++q) {
      const bool upright = q % 2 == 0;
      images_[q] =
          LayeredBitmap(layers, upright ? width : height, upright ? height : width, border);
    }
  }

  const CellIndex& size() const { return size_; }
  const LayeredBitmap& image(int quarter) const { return images_[quarter]; }

  void set(int layer, CellIndex cell, bool value = true) {
    for (int q = 0; q < kQuarters; ++q) {
      const CellIndex at = turn(cell, q);
      images_[q].set(layer, at.x, at.y, value);
    }
  }

  /// Where a cell lies in an image.
  CellIndex turn(CellIndex cell, int quarter) const { return turned(cell, size_, quarter); }
  /// Which cell lies there.
  CellIndex turnBack(CellIndex cell, int quarter) const {
    switch (quarter) {
      case 1:
        return {size_.x - 1 - cell.y, cell.x};
      case 2:
        return {size_.x - 1 - cell.x, size_.y - 1 - cell.y};
      case 3:
        return {cell.y, size_.y - 1 - cell.x};
      default:
        return cell;
    }
  }

  /// Differs if any cell of any image does, but for chance.
  std::uint64_t fingerprint() const {
    std::uint64_t hash = 0;
    for (const LayeredBitmap& image : images_) hash = hash * 31 + image.fingerprint();
    return hash;
  }

 private:
  CellIndex size_;
  std::array<LayeredBitmap, kQuarters> images_;
};

}  // namespace casepush
