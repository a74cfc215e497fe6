#include "casepush/world/static_table.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "run_images.h"
#include "turned_bitmaps.h"

namespace casepush {
namespace {

constexpr int kByte = 8;
constexpr int kStep = LayeredBitmap::kRowStep;
constexpr int kBits = LayeredBitmap::kBits;
constexpr int kHeadingsOfAQuarter = Sweep::kHeadings / TurnedBitmaps::kQuarters;
/// So that the last start's word can be read whole.
constexpr std::size_t kSpareBytes = sizeof(std::uint64_t);

/// Bit i of byte k becomes bit k of byte i.
std::uint64_t transposed(std::uint64_t bits) {
  const auto swap = [&bits](int distance, std::uint64_t lower) {
    const std::uint64_t differ = (bits ^ bits >> distance) & lower;
    bits ^= differ ^ differ << distance;
  };
  swap(7, 0x00aa00aa00aa00aaULL);
  swap(14, 0x0000cccc0000ccccULL);
  swap(28, 0x00000000f0f0f0f0ULL);
  return bits;
}

std::uint64_t wordAt(const std::uint8_t* bytes) {
  std::uint64_t word = 0;
  for (int i = 0; i < kByte; ++i) word |= std::uint64_t{bytes[i]} << i * kByte;
  return word;
}

double megabytes(std::size_t bytes) { return std::ceil(static_cast<double>(bytes) / 1e5) / 10.0; }

void requireMemory(std::size_t bytes, std::size_t limit_bytes, int sweeps, const CellIndex& size) {
  if (bytes <= limit_bytes) return;
  std::ostringstream what;
  what << sweeps << " sweeps on a map of " << size.x << " x " << size.y << " cells take "
       << megabytes(bytes) << " MB, the limit is " << megabytes(limit_bytes)
       << " MB; take fewer sweeps, a smaller or coarser map, or a larger limit";
  throw InputError("static table", what.str());
}

void requireReach(const std::vector<const Sweep*>& sweeps, double reach_m) {
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    if (sweeps[i]->reach() <= reach_m) continue;
    std::ostringstream what;
    what << "sweep " << i << " reaches " << sweeps[i]->reach() << " m, the sweep checker is for "
         << reach_m << " m; make one for a longer reach or leave the sweep out";
    throw InputError("static table", what.str());
  }
}

}  // namespace

StaticTable::StaticTable(const SweepChecker& checker, const std::vector<const Sweep*>& sweeps,
                         std::size_t limit_bytes)
    : sweeps_(static_cast<int>(sweeps.size())), stride_((sweeps.size() + kByte - 1) / kByte) {
  CASEPUSH_CHECK(!sweeps.empty(), "no sweeps");
  const auto map = checker.collisions().mapColumns();
  origin_m_ = map->origin_m;
  cells_per_m_ = 1.0 / map->resolution_m;
  width_ = map->width;
  height_ = map->height;
  const std::size_t starts = std::size_t{Sweep::kHeadings} * width_ * height_;
  requireMemory(starts * stride_ + kSpareBytes, limit_bytes, sweeps_, {width_, height_});
  requireReach(sweeps, checker.reach());
  bytes_.resize(starts * stride_ + kSpareBytes);
  fill(checker, sweeps);
}

void StaticTable::fill(const SweepChecker& checker, const std::vector<const Sweep*>& sweeps) {
  const TurnedBitmaps& map = checker.mapImages();
  std::vector<RunImages> images;
  for (int q = 0; q < TurnedBitmaps::kQuarters; ++q) {
    const bool upright = q % 2 == 0;
    const CellIndex size{upright ? width_ : height_, upright ? height_ : width_};
    images.emplace_back(map.image(q), map.image(q).layers() - 1, size);
  }
  for (std::size_t group = 0; group < stride_; ++group) {
    // Sweeps of its own: the masks of all headings go when they have served.
    std::vector<std::unique_ptr<Sweep>> own;
    const std::size_t end = std::min(sweeps.size(), (group + 1) * kByte);
    for (std::size_t i = group * kByte; i < end; ++i) {
      own.push_back(std::make_unique<Sweep>(sweeps[i]->tracks(), checker.classes()));
    }
    for (int heading = 0; heading < Sweep::kHeadings; ++heading) {
      const double yaw_rad = heading * 2.0 * M_PI / Sweep::kHeadings;
      const int quarter = heading / kHeadingsOfAQuarter;
      std::vector<std::vector<std::uint64_t>> tiles;
      for (const auto& sweep : own) {
        tiles.push_back(images[quarter].meet(*sweep->mask(yaw_rad).mask));
      }
      const bool upright = quarter % 2 == 0;
      write(tiles, heading, upright ? width_ : height_, upright ? height_ : width_, group);
    }
  }
}

// Turns bits of up to eight sweeps for eight starts into the starts' bytes.
void StaticTable::write(const std::vector<std::vector<std::uint64_t>>& tiles, int heading,
                        int width, int height, std::size_t group) {
  const std::size_t steps = (height + kStep - 1) / kStep;
  std::uint8_t* row = bytes_.data() + std::size_t{1} * heading * width * height * stride_ + group;
  for (int y = 0; y < height; ++y, row += width * stride_) {
    for (int x = 0; x < width; x += kByte) {
      const std::size_t word = x / kBits * steps * kStep + y;
      std::uint64_t bits = 0;
      for (std::size_t i = 0; i < tiles.size(); ++i) {
        bits |= (tiles[i][word] >> x % kBits & 0xff) << i * kByte;
      }
      bits = transposed(bits);
      const int count = std::min(kByte, width - x);
      for (int i = 0; i < count; ++i) {
        row[(x + i) * stride_] = static_cast<std::uint8_t>(bits >> i * kByte);
      }
    }
  }
}

std::uint64_t StaticTable::allOf(int word) const {
  return ~std::uint64_t{0} >> (kBits - std::min(kBits, sweeps_ - word * kBits));
}

std::uint64_t StaticTable::blocked(const Pose2& map_T_start, int word) const {
  const double x = (map_T_start.x() - origin_m_.x()) * cells_per_m_;
  const double y = (map_T_start.y() - origin_m_.y()) * cells_per_m_;
  const bool inside = x >= 0.0 && y >= 0.0 && x < width_ && y < height_;
  if (!inside || !std::isfinite(map_T_start.yaw())) return allOf(word);
  const int heading = Sweep::heading(map_T_start.yaw());
  const int quarter = heading / kHeadingsOfAQuarter;
  const CellIndex at =
      turned({static_cast<int>(x), static_cast<int>(y)}, {width_, height_}, quarter);
  const std::size_t width = quarter % 2 == 0 ? width_ : height_;
  const std::size_t start = std::size_t{1} * heading * width_ * height_ + at.y * width + at.x;
  return wordAt(bytes_.data() + start * stride_ + word * kByte) & allOf(word);
}

std::uint64_t StaticTable::free(const Pose2& map_T_start, int word) const {
  return ~blocked(map_T_start, word) & allOf(word);
}

}  // namespace casepush
