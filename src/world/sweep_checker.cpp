#include "casepush/world/sweep_checker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"
#include "checker_data.h"
#include "height_classes.h"
#include "layered_bitmap.h"
#include "placed_footprint.h"
#include "slab.h"
#include "sweep_mask.h"

namespace casepush {
namespace {

constexpr int kMaxReachCells = 1024;
constexpr int kBits = 64;

/// Bits of the slices that are occupied through their whole height. The lowest and the highest one
/// stand for all that lies beyond them and never count.
std::uint64_t filledSlices(const MapColumns& map, std::size_t column) {
  const double slice_m = map.columns.slice_m;
  const double cells = slice_m / map.columns.resolution_m;
  std::uint64_t bits = 0;
  for (std::uint32_t run = map.first_run[column]; run < map.first_run[column + 1]; ++run) {
    constexpr double kRounding = 1e-6;
    const int first =
        std::max(1, static_cast<int>(std::ceil(map.runs[run].low / cells - kRounding)));
    const int end =
        std::min(kSlices - 1, static_cast<int>(std::floor(map.runs[run].high / cells + kRounding)));
    for (int slice = first; slice < end; ++slice) bits |= std::uint64_t{1} << slice;
  }
  return bits;
}

}  // namespace

/// What is occupied in each class of heights; one more layer holds all of them.
struct SweepChecker::Images {
  LayeredBitmap occupied;
  LayeredBitmap filled;  ///< Of the map alone: through the whole height of some slice.

  void add(const HeightClasses& classes, int x, int y, std::uint64_t slices) {
    for (int c = 0; c < classes.count(); ++c) {
      if ((slices & classes.slices(c)) == 0) continue;
      occupied.set(c, x, y);
      occupied.set(classes.count(), x, y);
    }
  }
};

/// A sweep's mask at the cell of its start.
struct SweepChecker::Place {
  const SweepMask* mask = nullptr;
  int x = 0;
  int y = 0;
};

std::shared_ptr<const HeightClasses> SweepChecker::heightClasses(const CollisionChecker& checker,
                                                                 const Bodies& bodies) {
  return std::make_shared<HeightClasses>(bodies, checker.columns().slice_m);
}

SweepChecker::SweepChecker(CollisionChecker checker, std::shared_ptr<const HeightClasses> classes,
                           double reach_m)
    : checker_(std::move(checker)), classes_(std::move(classes)) {
  const MapColumns& map = *checker_.data_->map;
  const int width = map.columns.width;
  const int height = map.columns.height;
  const double reach_cells = std::ceil(reach_m / map.columns.resolution_m) + 2.0;
  const int border = static_cast<int>(std::clamp(reach_cells, 0.0, 1.0 * kMaxReachCells)) + kBits;
  auto images = std::make_shared<Images>();
  images->occupied = LayeredBitmap(classes_->count() + 1, width, height, border);
  images->filled = LayeredBitmap(classes_->count(), width, height, border);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t column = static_cast<std::size_t>(y) * width + x;
      const std::uint64_t slices = map.columns.bits[column];
      if (slices == 0) continue;
      images->add(*classes_, x, y, slices);
      const std::uint64_t filled = filledSlices(map, column);
      for (int c = 0; c < classes_->count(); ++c) {
        if ((filled & classes_->slices(c)) != 0) images->filled.set(c, x, y);
      }
    }
  }
  map_ = std::move(images);
  *this = withObstaclesOf(checker_);
}

SweepChecker SweepChecker::withObstaclesOf(CollisionChecker checker) const {
  CASEPUSH_CHECK(checker.data_->map == checker_.data_->map, "another map");
  SweepChecker result(*this);
  result.checker_ = std::move(checker);
  result.around_ = map_;
  if (result.checker_.obstacles().empty()) return result;
  auto images = std::make_shared<Images>(*map_);
  const CollisionChecker::Columns& columns = checker_.data_->map->columns;
  for (const PlacedSolid& placed : result.checker_.obstacles()) {
    visitCells(placed, columns, [&](std::size_t column, std::uint64_t slices) {
      images->add(*classes_, static_cast<int>(column % columns.width),
                  static_cast<int>(column / columns.width), slices);
    });
  }
  result.around_ = std::move(images);
  return result;
}

// False if the mask might reach beyond the images.
bool SweepChecker::place(const Sweep& sweep, const Pose2& map_T_start, Place* place) const {
  const CollisionChecker::Columns& columns = checker_.data_->map->columns;
  const Eigen::Vector2d at = (map_T_start.position() - columns.origin_m) / columns.resolution_m;
  const bool inside =
      at.x() >= 0.0 && at.y() >= 0.0 && at.x() < columns.width && at.y() < columns.height;
  const int border = around_->occupied.border() - kBits;
  if (!inside || sweep.reach() / columns.resolution_m + 2.0 > border) return false;
  place->mask = &sweep.mask(map_T_start.yaw());
  place->x = static_cast<int>(at.x()) + place->mask->first_column;
  place->y = static_cast<int>(at.y());
  return true;
}

bool SweepChecker::hitsOuter(const Place& place) const {
  const SweepMask& mask = *place.mask;
  const LayeredBitmap& occupied = around_->occupied;
  const auto hits = [&](int layer, const SweepMask::Layer& part) {
    return occupied.overlaps(layer, place.x, place.y + part.first_row,
                             mask.words.data() + part.offset, mask.strips, part.rows);
  };
  if (!hits(classes_->count(), mask.any)) return false;
  for (int c = 0; c < classes_->count(); ++c) {
    if (hits(c, mask.outer[c])) return true;
  }
  return false;
}

bool SweepChecker::hitsCertain(const Place& place) const {
  const SweepMask& mask = *place.mask;
  for (int c = 0; c < classes_->count(); ++c) {
    const SweepMask::Layer& part = mask.certain[c];
    if (map_->filled.overlaps(c, place.x, place.y + part.first_row, mask.words.data() + part.offset,
                              mask.strips, part.rows)) {
      return true;
    }
  }
  return false;
}

bool SweepChecker::mayCollide(const Sweep& sweep, const Pose2& map_T_start) const {
  Place at;
  if (!map_T_start.isFinite()) return true;
  if (!place(sweep, map_T_start, &at)) return collidesPoseByPose(sweep, map_T_start);
  return hitsOuter(at);
}

bool SweepChecker::collides(const Sweep& sweep, const Pose2& map_T_start) const {
  Place at;
  if (!map_T_start.isFinite()) return true;
  if (!place(sweep, map_T_start, &at)) return collidesPoseByPose(sweep, map_T_start);
  return hitsOuter(at) && (hitsCertain(at) || touchesHitCells(sweep, map_T_start, at));
}

bool SweepChecker::touchesHitCells(const Sweep& sweep, const Pose2& map_T_start,
                                   const Place& place) const {
  const SweepMask& mask = *place.mask;
  const CollisionChecker::Columns& map = checker_.data_->map->columns;
  const CollisionChecker::Columns& around = checker_.columns();
  bool outside = false;
  bool solids = false;
  for (int c = 0; c < classes_->count(); ++c) {
    const SweepMask::Layer& layer = mask.outer[c];
    const std::uint64_t* word = mask.words.data() + layer.offset;
    for (int i = 0; i < mask.strips * layer.rows; ++i) {
      const int x0 = place.x + i / layer.rows * kBits;
      const int y = place.y + layer.first_row + i % layer.rows;
      std::uint64_t hits = word[i] == 0 ? 0 : word[i] & around_->occupied.word(c, x0, y);
      for (; hits != 0; hits &= hits - 1) {
        const int x = x0 + __builtin_ctzll(hits);
        if (x < 0 || y < 0 || x >= map.width || y >= map.height) {
          outside = true;
          continue;
        }
        const std::size_t column = static_cast<std::size_t>(y) * map.width + x;
        const std::uint64_t own = map.bits[column] & classes_->slices(c);
        if (own != 0 && touchesCell(sweep, map_T_start, column)) return true;
        solids = solids || (around.bits[column] & classes_->slices(c)) != own;
      }
    }
  }
  return (outside || solids) && touchesRest(sweep, map_T_start, outside, solids);
}

bool SweepChecker::touchesCell(const Sweep& sweep, const Pose2& map_T_start,
                               std::size_t column) const {
  const MapColumns& map = *checker_.data_->map;
  const double resolution_m = map.columns.resolution_m;
  const Eigen::Vector2d corner = columnCorner(map.columns, column);
  const Eigen::Vector2d centre =
      map_T_start.inverse() * Eigen::Vector2d(corner.array() + resolution_m / 2.0);
  for (const Track& track : sweep.tracks()) {
    const double near_m = track.body->reach() + resolution_m * M_SQRT1_2;
    for (const Pose2& pose : track.start_T_body) {
      if ((pose.position() - centre).squaredNorm() > near_m * near_m) continue;
      if (PlacedFootprint(*track.body, map_T_start * pose).depthIn(map, column) > 0.0) return true;
    }
  }
  return false;
}

bool SweepChecker::touchesRest(const Sweep& sweep, const Pose2& map_T_start, bool outside,
                               bool solids) const {
  const CollisionChecker::Data& data = *checker_.data_;
  for (const Track& track : sweep.tracks()) {
    for (const Pose2& pose : track.start_T_body) {
      const Pose2 map_T_body = map_T_start * pose;
      if (outside && data.mayReachOut(*track.body, map_T_body) &&
          PlacedFootprint(*track.body, map_T_body).depthOutside(data.map->min_m, data.map->max_m) >
              0.0) {
        return true;
      }
      if (solids && data.overlapsObstacle(*track.body, map_T_body)) return true;
    }
  }
  return false;
}

bool SweepChecker::collidesPoseByPose(const Sweep& sweep, const Pose2& map_T_start) const {
  if (!map_T_start.isFinite()) return true;
  for (const Track& track : sweep.tracks()) {
    // From the end on: that is where long motions meet something.
    for (auto pose = track.start_T_body.rbegin(); pose != track.start_T_body.rend(); ++pose) {
      if (checker_.collides(*track.body, map_T_start * *pose)) return true;
    }
  }
  return false;
}

}  // namespace casepush
