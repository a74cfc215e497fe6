#pragma once

#include "layered_bitmap.h"
#include "sweep_mask.h"

namespace casepush {

enum class MaskAnswer {
  kFree,     ///< Nothing lies where anything may be covered.
  kMay,      ///< Something does.
  kCertain,  ///< Something lies where something certainly is.
};

/// Compares a mask with images: layers 0, 1, ... of the classes, and in `occupied` one more of all
/// together. Bit 0 of the mask lies at cell (x, y).
/// @param filled  What counts for kCertain; null: do not ask.
/// @pre the mask lies within the images and their borders.
MaskAnswer testMask(const SweepMask& mask, const LayeredBitmap& occupied,
                    const LayeredBitmap* filled, int x, int y);

}  // namespace casepush
