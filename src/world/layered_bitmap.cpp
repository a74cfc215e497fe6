#include "layered_bitmap.h"

#include <cstring>

namespace casepush {
namespace {

constexpr int kBits = 64;
constexpr int kSpareRows = LayeredBitmap::kRowStep;  // Masks are padded to whole steps.

using Words = std::uint64_t __attribute__((vector_size(64)));
constexpr int kStep = LayeredBitmap::kRowStep;
static_assert(sizeof(Words) == kStep * sizeof(std::uint64_t), "a step of rows is one vector");

// One function, compiled for vectors of several lengths; the processor's is chosen at start-up.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define CASEPUSH_VECTORISED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CASEPUSH_VECTORISED
#endif

/// Where the images lie in memory.
struct Layout {
  const std::uint64_t* words;  ///< Of layer 0 at the mask's first column and row 0.
  std::size_t layer_stride;
  std::size_t strip_stride;
};

/// Does any of the parts meet its image, shifted by `shift` bits over two strips?
CASEPUSH_VECTORISED
bool anyCommon(const Layout& image, const LayeredBitmap::Part* parts, int count, int first_layer,
               const std::uint64_t* words, int strips, unsigned shift) {
  constexpr int kGlance = 2 * kStep;  // Rows between looks at the result.
  for (int i = 0; i < count; ++i) {
    const LayeredBitmap::Part& part = parts[i];
    const std::uint64_t* mask = words + part.offset;
    const std::uint64_t* low =
        image.words + (first_layer + i) * image.layer_stride + part.first_row;
    for (int s = 0; s < strips; ++s, mask += part.rows, low += image.strip_stride) {
      const std::uint64_t* high = low + image.strip_stride;
      for (int begin = 0; begin < part.rows; begin += kGlance) {
        const int end = begin + kGlance < part.rows ? begin + kGlance : part.rows;
        Words common = {0, 0, 0, 0, 0, 0, 0, 0};
        for (int row = begin; row < end; row += kStep) {
          Words m;
          Words l;
          Words h;
          std::memcpy(&m, mask + row, sizeof(m));
          std::memcpy(&l, low + row, sizeof(l));
          std::memcpy(&h, high + row, sizeof(h));
          // Shifted in two steps: a shift by all 64 bits is not defined.
          common |= m & (l >> shift | (h << 1) << (kBits - 1 - shift));
        }
        std::uint64_t all = 0;
        for (int k = 0; k < kStep; ++k) all |= common[k];
        if (all != 0) return true;
      }
    }
  }
  return false;
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

bool LayeredBitmap::overlaps(int first_layer, const Part* parts, int count,
                             const std::uint64_t* words, int strips, int x, int y) const {
  const int column = x + border_;
  const Layout layout{strip(0, column / kBits) + y + border_,
                      static_cast<std::size_t>(strips_) * rows_, static_cast<std::size_t>(rows_)};
  return anyCommon(layout, parts, count, first_layer, words, strips,
                   static_cast<unsigned>(column) % kBits);
}

std::uint64_t LayeredBitmap::word(int layer, int x, int y) const {
  const int column = x + border_;
  const unsigned shift = static_cast<unsigned>(column) % kBits;
  const std::uint64_t* low = strip(layer, column / kBits) + y + border_;
  return low[0] >> shift | (low[rows_] << 1) << (kBits - 1 - shift);
}

}  // namespace casepush
