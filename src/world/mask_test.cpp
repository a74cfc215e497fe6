#include "mask_test.h"

#include <cstring>

#include "tile_words.h"

namespace casepush {
namespace {

constexpr int kStep = LayeredBitmap::kRowStep;

/// Does a tile's mask meet the image there?
CASEPUSH_INLINE bool meets(const std::uint64_t* mask, const std::uint64_t* image,
                           std::ptrdiff_t strip, unsigned shift) {
  TileWords m;
  std::memcpy(&m, mask, sizeof(m));
  TileWords cells;
  readTile(image, strip, shift, &cells);
  const TileWords common = m & cells;
  std::uint64_t all = 0;
  for (int k = 0; k < kStep; ++k) all |= common[k];
  return all != 0;
}

/// Does any of the classes' masks, one line each, meet its layer?
CASEPUSH_INLINE bool anyMeets(const std::uint64_t* lines, unsigned classes,
                              const LayeredBitmap::Window& image, std::ptrdiff_t offset) {
  for (; classes != 0; classes &= classes - 1, lines += kStep) {
    const std::ptrdiff_t layer = __builtin_ctz(classes);
    if (meets(lines, image.words + layer * image.layer + offset, image.strip, image.shift)) {
      return true;
    }
  }
  return false;
}

CASEPUSH_VECTORISED
MaskAnswer test(const SweepMask& mask, const LayeredBitmap::Window& occupied, int all_layer,
                const LayeredBitmap::Window* filled) {
  const std::uint64_t* all = occupied.words + all_layer * occupied.layer;
  MaskAnswer answer = MaskAnswer::kFree;
  const int steps = mask.steps();
  for (int s = 0; s < mask.strips(); ++s) {
    // From the middle on, where most is covered.
    int k = steps / 2;
    for (int i = 1; i <= steps; k += i % 2 == 0 ? i : -i, ++i) {
      const int tile = s * steps + k;
      const std::ptrdiff_t offset = s * occupied.strip + std::ptrdiff_t{k} * kStep;
      if (!meets(mask.any(tile), all + offset, occupied.strip, occupied.shift)) continue;
      const SweepMask::Tile classes = mask.tile(tile);
      const std::uint64_t* lines = mask.line(classes.line);
      if (answer == MaskAnswer::kFree && !anyMeets(lines, classes.outer, occupied, offset)) {
        continue;
      }
      answer = MaskAnswer::kMay;
      if (filled == nullptr) return answer;
      lines += __builtin_popcount(classes.outer) * kStep;
      if (anyMeets(lines, classes.certain, *filled, offset)) return MaskAnswer::kCertain;
    }
  }
  return answer;
}

}  // namespace

MaskAnswer testMask(const SweepMask& mask, const LayeredBitmap& occupied,
                    const LayeredBitmap* filled, int x, int y) {
  const LayeredBitmap::Window image = occupied.window(x, y);
  if (filled == nullptr) return test(mask, image, occupied.layers() - 1, nullptr);
  const LayeredBitmap::Window certain = filled->window(x, y);
  return test(mask, image, occupied.layers() - 1, &certain);
}

}  // namespace casepush
