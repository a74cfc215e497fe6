#include "run_images.h"

#include <algorithm>

#include "tile_words.h"

namespace casepush {
namespace {

constexpr int kBits = LayeredBitmap::kBits;
constexpr int kStep = LayeredBitmap::kRowStep;
constexpr int kLevels = 7;  // Runs of 1, 2, 4, ..., 64 cells.

CASEPUSH_VECTORISED
void join(const RunImages::Piece* pieces, std::size_t count, std::ptrdiff_t strip,
          std::ptrdiff_t offset, std::uint64_t* tile) {
  TileWords all{};
  for (std::size_t i = 0; i < count; ++i) {
    TileWords cells;
    readTile(pieces[i].words + offset, strip, pieces[i].shift, &cells);
    all |= cells;
  }
  std::memcpy(tile, &all, sizeof(all));
}

}  // namespace

RunImages::RunImages(const LayeredBitmap& image, int classes, CellIndex size)
    : size_(size), border_(image.border()) {
  const LayeredBitmap::Window all = image.window(-border_, -border_);
  strip_ = all.strip;
  image_size_ = static_cast<std::size_t>(all.layer);
  words_.resize(image_size_ * classes * kLevels);
  for (int c = 0; c < classes; ++c) {
    const std::uint64_t* words = all.words + c * all.layer;
    std::copy(words, words + all.layer,
              words_.begin() + static_cast<std::ptrdiff_t>(imageOf(c, 0)));
    for (int level = 1; level < kLevels; ++level) widen(c, level);
  }
}

int RunImages::strips() const { return (size_.x + kBits - 1) / kBits; }

int RunImages::steps() const { return (size_.y + kStep - 1) / kStep; }

std::size_t RunImages::imageOf(int height_class, int level) const {
  return (static_cast<std::size_t>(height_class) * kLevels + level) * image_size_;
}

// A run is two of half its length. Beyond the last strip all is border.
void RunImages::widen(int height_class, int level) {
  const std::uint64_t* half = words_.data() + imageOf(height_class, level - 1);
  std::uint64_t* whole = words_.data() + imageOf(height_class, level);
  const int shift = 1 << (level - 1);
  for (std::size_t i = 0; i < image_size_; ++i) {
    const std::size_t next = i + static_cast<std::size_t>(strip_);
    const std::uint64_t beyond = next < image_size_ ? half[next] : ~std::uint64_t{0};
    whole[i] = half[i] | half[i] >> shift | beyond << (kBits - shift);
  }
}

RunImages::Piece RunImages::pieceAt(int height_class, int level, int x, int y) const {
  const int column = x + border_;
  return {words_.data() + imageOf(height_class, level) + column / kBits * strip_ + y + border_,
          static_cast<unsigned>(column % kBits)};
}

void RunImages::addRuns(int height_class, int x, int y, std::uint64_t row,
                        std::vector<Piece>* pieces) const {
  while (row != 0) {
    const int first = __builtin_ctzll(row);
    const std::uint64_t after = ~(row >> first);
    const int length = after == 0 ? kBits : __builtin_ctzll(after);
    int level = 0;
    while (2 << level <= length) ++level;
    const int rest = length - (1 << level);
    pieces->push_back(pieceAt(height_class, level, x + first, y));
    if (rest > 0) pieces->push_back(pieceAt(height_class, level, x + first + rest, y));
    const int end = first + length;
    row = end < kBits ? row >> end << end : 0;
  }
}

std::vector<std::uint64_t> RunImages::meet(const SweepMask& mask) const {
  std::vector<Piece> pieces;
  for (int t = 0; t < mask.strips() * mask.steps(); ++t) {
    const int x = mask.firstColumn() + t / mask.steps() * kBits;
    const int y = mask.firstRow() + t % mask.steps() * kStep;
    const std::uint64_t* line = mask.line(mask.tile(t).line);
    for (unsigned classes = mask.tile(t).outer; classes != 0; classes &= classes - 1) {
      const int height_class = __builtin_ctz(classes);
      for (int row = 0; row < kStep; ++row) addRuns(height_class, x, y + row, line[row], &pieces);
      line += kStep;
    }
  }
  std::vector<std::uint64_t> tiles(static_cast<std::size_t>(strips()) * steps() * kStep);
  std::uint64_t* tile = tiles.data();
  for (int s = 0; s < strips(); ++s) {
    for (int k = 0; k < steps(); ++k, tile += kStep) {
      join(pieces.data(), pieces.size(), strip_, s * strip_ + std::ptrdiff_t{k} * kStep, tile);
    }
  }
  return tiles;
}

}  // namespace casepush
