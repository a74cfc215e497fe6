#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "layered_bitmap.h"

// For functions compiled for vectors of several lengths; the processor's is chosen at start-up.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CASEPUSH_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#define CASEPUSH_INLINE inline __attribute__((always_inline))
#else
#define CASEPUSH_VECTORISED
#define CASEPUSH_INLINE inline
#endif

namespace casepush {

/// The words of a tile of 64 x 8 cells, row by row.
using TileWords = std::uint64_t __attribute__((vector_size(64)));
static_assert(sizeof(TileWords) == LayeredBitmap::kRowStep * sizeof(std::uint64_t),
              "a tile is one vector");

/// Reads a tile of an image that lies as LayeredBitmap::Window tells.
CASEPUSH_INLINE void readTile(const std::uint64_t* words, std::ptrdiff_t strip, unsigned shift,
                              TileWords* cells) {
  TileWords low;
  TileWords high;
  std::memcpy(&low, words, sizeof(low));
  std::memcpy(&high, words + strip, sizeof(high));
  // Shifted in two steps: a shift by all 64 bits is not defined.
  *cells = low >> shift | (high << 1) << (LayeredBitmap::kBits - 1 - shift);
}

}  // namespace casepush
