#pragma once

#include <cstdint>
#include <vector>

namespace casepush {

/// Bit images of equal size on top of each other, laid out for tests of whole masks at once: words
/// of 64 cells along x, those of a strip of x stacked along y.
///
/// Around the image lies a border whose cells are set.
class LayeredBitmap {
 public:
  LayeredBitmap() = default;
  LayeredBitmap(int layers, int width, int height, int border);

  int layers() const { return layers_; }
  int border() const { return border_; }
  void set(int layer, int x, int y, bool value = true);
  bool test(int layer, int x, int y) const;

  /// Is any cell set in a mask of `strips` strips of `rows` words each, whose first bit lies at
  /// cell (x, y)? @pre rows is a multiple of 4; the mask lies within the image and its border.
  bool overlaps(int layer, int x, int y, const std::uint64_t* mask, int strips, int rows) const;

  /// The 64 cells of row y from x on. @pre as for overlaps().
  std::uint64_t word(int layer, int x, int y) const;

 private:
  const std::uint64_t* strip(int layer, int strip) const {
    return words_.data() + (static_cast<std::size_t>(layer) * strips_ + strip) * rows_;
  }

  int layers_ = 0;
  int border_ = 0;
  int strips_ = 0;
  int rows_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace casepush
