#include "layered_bitmap.h"

namespace casepush {
namespace {

constexpr int kSpareRows = LayeredBitmap::kRowStep;  // Masks are padded to whole steps.

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

std::uint64_t LayeredBitmap::fingerprint() const {
  std::uint64_t hash = words_.size();
  for (const std::uint64_t word : words_) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29;
  }
  return hash;
}

std::uint64_t LayeredBitmap::word(int layer, int x, int y) const {
  const Window at = window(x, y);
  const std::uint64_t* low = at.words + layer * at.layer;
  return low[0] >> at.shift | (low[at.strip] << 1) << (kBits - 1 - at.shift);
}

}  // namespace casepush
