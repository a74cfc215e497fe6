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
  static constexpr int kRowStep = 8;  ///< Masks' rows come in multiples of this.

  LayeredBitmap() = default;
  LayeredBitmap(int layers, int width, int height, int border);

  int layers() const { return layers_; }
  int border() const { return border_; }
  void set(int layer, int x, int y, bool value = true);
  bool test(int layer, int x, int y) const;

  /// A mask's words for one layer: strip after strip, `rows` words each.
  struct Part {
    std::int16_t first_row = 0;
    std::int16_t rows = 0;    ///< A multiple of kRowStep; 0: empty.
    std::int32_t offset = 0;  ///< Of the first word.
  };

  /// Is any cell set that a mask covers in its layer? Part i belongs to layer `first_layer` + i;
  /// bit 0 of the first strip's row 0 lies at cell (x, y).
  /// @pre the mask lies within the image and its border.
  bool overlaps(int first_layer, const Part* parts, int count, const std::uint64_t* words,
                int strips, int x, int y) const;

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
