#include "sweep_mask.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>

#include "casepush/common/check.h"

namespace casepush {
namespace {

constexpr int kTileWords = SweepMask::kTileWords;
constexpr std::align_val_t kAlignment{alignof(SweepMask)};

using Line = std::array<std::uint64_t, kTileWords>;

Line lineOf(const MaskCanvas& canvas, int height_class, int strip, int step) {
  const std::uint64_t* words = canvas.column(height_class, strip) + step * kTileWords;
  Line line;
  std::copy(words, words + kTileWords, line.begin());
  return line;
}

bool isEmpty(const Line& line) {
  return std::all_of(line.begin(), line.end(), [](std::uint64_t word) { return word == 0; });
}

/// Appends what the classes have in a tile and returns which of them have anything.
std::uint8_t appendClasses(const MaskCanvas& canvas, int strip, int step,
                           std::vector<Line>* lines) {
  std::uint8_t present = 0;
  for (int c = 0; c < canvas.classes(); ++c) {
    const Line line = lineOf(canvas, c, strip, step);
    if (isEmpty(line)) continue;
    lines->push_back(line);
    present = static_cast<std::uint8_t>(present | 1U << c);
  }
  return present;
}

}  // namespace

void SweepMask::Free::operator()(const SweepMask* mask) const {
  mask->~SweepMask();
  ::operator delete(const_cast<SweepMask*>(mask), kAlignment);
}

SweepMask::Pointer SweepMask::of(const MaskCanvas& outer, const MaskCanvas& certain) {
  const int strips = outer.strips();
  const int steps = outer.rows() / kTileWords;
  constexpr std::size_t kTilesPerLine = sizeof(Line) / sizeof(Tile);
  const std::size_t tiles = static_cast<std::size_t>(strips) * steps;
  const std::size_t more = tiles > kOwnTiles ? tiles - kOwnTiles : 0;
  std::vector<Line> lines(tiles + (more + kTilesPerLine - 1) / kTilesPerLine, Line{});
  std::vector<Tile> list;
  for (int s = 0; s < strips; ++s) {
    for (int k = 0; k < steps; ++k) {
      Tile tile{};
      CASEPUSH_CHECK(lines.size() <= UINT16_MAX, lines.size() << " lines");
      tile.line = static_cast<std::uint16_t>(lines.size());
      tile.outer = appendClasses(outer, s, k, &lines);
      for (std::size_t i = tile.line; i < lines.size(); ++i) {
        for (int w = 0; w < kTileWords; ++w) lines[list.size()][w] |= lines[i][w];
      }
      tile.certain = appendClasses(certain, s, k, &lines);
      list.push_back(tile);
    }
  }
  const std::size_t own = tiles - more;
  if (more > 0) std::memcpy(lines[tiles].data(), list.data() + own, more * sizeof(Tile));
  void* memory = ::operator new(sizeof(SweepMask) + lines.size() * sizeof(Line), kAlignment);
  auto* mask = new (memory) SweepMask;
  mask->first_column_ = outer.box().x0;
  mask->first_row_ = outer.box().y0;
  mask->strips_ = static_cast<std::int16_t>(strips);
  mask->steps_ = static_cast<std::int16_t>(steps);
  mask->lines_ = static_cast<std::uint32_t>(1 + lines.size());
  std::copy(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(own), mask->tiles_.begin());
  std::memcpy(static_cast<void*>(mask + 1), lines.data(), lines.size() * sizeof(Line));
  return Pointer(mask);
}

SweepMask::Pointer makeSweepMask(const std::vector<SweptShape>& covering,
                                 const std::vector<SweptShape>& covered, int classes,
                                 double yaw_rad, double half_bin_rad, double resolution_m) {
  MaskPen pen(yaw_rad, half_bin_rad, resolution_m);
  MaskCanvas outer(pen.boxOf(covering), classes);
  for (const SweptShape& shape : covering) pen.drawCovering(shape, &outer);
  MaskCanvas certain(outer.box(), classes);
  for (const SweptShape& shape : covered) pen.drawCertain(shape, &certain);
  return SweepMask::of(outer, certain);
}

}  // namespace casepush
