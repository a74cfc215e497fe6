#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace casepush {

/// Bit images of equal size on top of each other, laid out for tests of whole masks at once: words
/// of 64 cells along x, those of a strip of x stacked along y.
///
/// Around the image lies a border whose cells are set.
class LayeredBitmap {
 public:
  static constexpr int kBits = 64;    ///< Cells of a word.
  static constexpr int kRowStep = 8;  ///< Words are read in multiples of this along y.

  LayeredBitmap() = default;
  LayeredBitmap(int layers, int width, int height, int border);

  int layers() const { return layers_; }
  int border() const { return border_; }
  void set(int layer, int x, int y, bool value = true);
  bool test(int layer, int x, int y) const;

  /// The 64 cells of row y from x on. @pre they lie within the image and its border.
  std::uint64_t word(int layer, int x, int y) const;

  /// Where the cells around (x, y) lie in memory: those of row y + j begin in word j at bit
  /// `shift`, and go on in the word `strip` farther on.
  struct Window {
    const std::uint64_t* words;  ///< Of layer 0.
    std::ptrdiff_t strip;        ///< Words from one strip to the next.
    std::ptrdiff_t layer;        ///< Words from one layer to the next.
    unsigned shift;
  };
  Window window(int x, int y) const {
    const int column = x + border_;
    return {strip(0, column / kBits) + y + border_, rows_,
            static_cast<std::ptrdiff_t>(strips_) * rows_, static_cast<unsigned>(column) % kBits};
  }

  /// Differs if any cell does, but for chance.
  std::uint64_t fingerprint() const;

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
