#include "layered_bitmap.h"

#include <cstring>

namespace casepush {
namespace {

constexpr int kBits = 64;
constexpr int kSpareRows = 4;  // Masks are padded to whole vectors.

using Words = std::uint64_t __attribute__((vector_size(32)));

// One function, compiled for processors with and without 256-bit vectors and chosen at start-up.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CASEPUSH_VECTORISED __attribute__((target_clones("avx2", "default")))
#else
#define CASEPUSH_VECTORISED
#endif

/// Does any of the masks' rows meet the image, shifted by `shift` bits over two strips?
CASEPUSH_VECTORISED
bool anyCommon(const std::uint64_t* mask, const std::uint64_t* low, const std::uint64_t* high,
               int rows, unsigned shift) {
  constexpr int kStep = 4;
  Words common = {0, 0, 0, 0};
  for (int row = 0; row < rows; row += kStep) {
    Words m;
    Words l;
    Words h;
    std::memcpy(&m, mask + row, sizeof(m));
    std::memcpy(&l, low + row, sizeof(l));
    std::memcpy(&h, high + row, sizeof(h));
    // Shifted in two steps: a shift by all 64 bits is not defined.
    common |= m & (l >> shift | (h << 1) << (kBits - 1 - shift));
  }
  return (common[0] | common[1] | common[2] | common[3]) != 0;
}

}  // namespace

LayeredBitmap::LayeredBitmap(int layers, int width, int height, int border)
    : layers_(layers),
      border_(border),
      strips_((width + 2 * border) / kBits + 2),
      rows_(height + 2 * border + kSpareRows),
      words_(static_cast<std::size_t>(layers) * strips_ * rows_, ~std::uint64_t{0}) {
  for (int layer = 0; layer < layers; ++layer) {
    for (int s = 0; s < strips_; ++s) {
      std::uint64_t outside = 0;
      for (int bit = 0; bit < kBits; ++bit) {
        const int x = s * kBits + bit - border;
        if (x < 0 || x >= width) outside |= std::uint64_t{1} << bit;
      }
      std::uint64_t* words =
          words_.data() + (static_cast<std::size_t>(layer) * strips_ + s) * rows_;
      for (int y = 0; y < height; ++y) words[y + border] = outside;
    }
  }
}

void LayeredBitmap::set(int layer, int x, int y, bool value) {
  const int column = x + border_;
  std::uint64_t& word =
      words_[(static_cast<std::size_t>(layer) * strips_ + column / kBits) * rows_ + y + border_];
  const std::uint64_t bit = std::uint64_t{1} << (column % kBits);
  word = value ? word | bit : word & ~bit;
}

bool LayeredBitmap::test(int layer, int x, int y) const {
  const int column = x + border_;
  return (strip(layer, column / kBits)[y + border_] >> (column % kBits) & 1) != 0;
}

bool LayeredBitmap::overlaps(int layer, int x, int y, const std::uint64_t* mask, int strips,
                             int rows) const {
  const int column = x + border_;
  const unsigned shift = static_cast<unsigned>(column) % kBits;
  const std::uint64_t* low = strip(layer, column / kBits) + y + border_;
  for (int s = 0; s < strips; ++s) {
    if (anyCommon(mask + static_cast<std::size_t>(s) * rows, low, low + rows_, rows, shift)) {
      return true;
    }
    low += rows_;
  }
  return false;
}

std::uint64_t LayeredBitmap::word(int layer, int x, int y) const {
  const int column = x + border_;
  const unsigned shift = static_cast<unsigned>(column) % kBits;
  const std::uint64_t* low = strip(layer, column / kBits) + y + border_;
  return low[0] >> shift | (low[rows_] << 1) << (kBits - 1 - shift);
}

}  // namespace casepush
