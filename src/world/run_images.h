#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "casepush/world/cell_box.h"
#include "layered_bitmap.h"
#include "sweep_mask.h"

namespace casepush {

/// Tells for all places on an image at once where a mask meets it.
///
/// For each class it holds the image and those of runs of 2, 4, ..., 64 cells along x: where any
/// cell of the run that begins there is set. A run of any length takes two of them, and a mask at
/// most two for each of its runs, shifted and joined for 64 x 8 places at a time.
class RunImages {
 public:
  /// @param classes  Layers 0, ..., classes - 1 of the image count.
  /// @param size  Of the image without its border.
  RunImages(const LayeredBitmap& image, int classes, CellIndex size);

  /// Tiles of 64 x 8 places, strip after strip; what lies beyond the image means nothing.
  int strips() const;
  int steps() const;  ///< Tiles of a strip.

  /// Words of all tiles; a bit is set where the mask of a start in that cell meets the image.
  /// @pre the mask stays within the image's border wherever in the image its start lies.
  std::vector<std::uint64_t> meet(const SweepMask& mask) const;

  /// An image and how far to shift it, so that the answers for the start at cell (0, 0) and its
  /// neighbours come first.
  struct Piece {
    const std::uint64_t* words;
    unsigned shift;
  };

 private:
  std::size_t imageOf(int height_class, int level) const;
  void widen(int height_class, int level);
  void addRuns(int height_class, int x, int y, std::uint64_t row, std::vector<Piece>* pieces) const;
  Piece pieceAt(int height_class, int level, int x, int y) const;

  CellIndex size_;
  int border_;
  std::ptrdiff_t strip_;    ///< Words from one strip to the next.
  std::size_t image_size_;  ///< Words of an image.
  std::vector<std::uint64_t> words_;
};

}  // namespace casepush
