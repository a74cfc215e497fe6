#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "layered_bitmap.h"
#include "mask_canvas.h"

namespace casepush {

/// Bit masks of what a sweep covers at one heading, relative to the cell of its start.
///
/// Cut into tiles of 64 x 8 cells, strip after strip. All lies in one block of memory, in the order
/// in which a test reads it: this header, for each tile what may be covered in any class, the
/// tiles that the header has no room for, and for each tile the masks of the classes.
class alignas(64) SweepMask {
 public:
  static constexpr int kTileWords = LayeredBitmap::kRowStep;

  /// Which masks a tile has besides that of all classes together.
  struct Tile {
    std::uint16_t line;    ///< Where they begin: those of the classes in `outer`, then `certain`.
    std::uint8_t outer;    ///< Bits of the classes of which something may be covered.
    std::uint8_t certain;  ///< Bits of the classes of which something certainly is.
  };

  struct Free {
    void operator()(const SweepMask* mask) const;
  };
  using Pointer = std::unique_ptr<const SweepMask, Free>;

  /// @pre both canvases have the same box and classes.
  static Pointer of(const MaskCanvas& outer, const MaskCanvas& certain);

  int firstColumn() const { return first_column_; }
  int firstRow() const { return first_row_; }
  int strips() const { return strips_; }
  int steps() const { return steps_; }  ///< Tiles of a strip.
  std::size_t bytes() const { return std::size_t{lines_} * sizeof(SweepMask); }

  /// Words of a line after the header's; a tile's are one line.
  const std::uint64_t* line(int index) const {
    return reinterpret_cast<const std::uint64_t*>(this + 1) + std::ptrdiff_t{index} * kTileWords;
  }
  const std::uint64_t* any(int tile) const { return line(tile); }
  Tile tile(int index) const {
    return index < kOwnTiles
               ? tiles_[index]
               : reinterpret_cast<const Tile*>(line(strips_ * steps_))[index - kOwnTiles];
  }

 private:
  static constexpr int kOwnTiles = 12;

  SweepMask() = default;

  std::int32_t first_column_ = 0;
  std::int32_t first_row_ = 0;
  std::int16_t strips_ = 0;
  std::int16_t steps_ = 0;
  std::uint32_t lines_ = 0;
  std::array<Tile, kOwnTiles> tiles_{};
};
static_assert(sizeof(SweepMask) == 64, "the header is one line");

/// Rasterises shapes turned by `yaw_rad`, valid for headings within +- `half_bin_rad` of it and
/// whatever place the start has in its cell.
SweepMask::Pointer makeSweepMask(const std::vector<SweptShape>& covering,
                                 const std::vector<SweptShape>& covered, int classes,
                                 double yaw_rad, double half_bin_rad, double resolution_m);

}  // namespace casepush
