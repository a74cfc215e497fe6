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
  const int classes = classes_->count();
  return occupied.overlaps(classes, &mask.any, 1, mask.words.data(), mask.strips, place.x,
                           place.y) &&
         occupied.overlaps(0, mask.outer.data(), classes, mask.words.data(), mask.strips, place.x,
                           place.y);
}

bool SweepChecker::hitsCertain(const Place& place) const {
  const SweepMask& mask = *place.mask;
  return map_->filled.overlaps(0, mask.certain.data(), classes_->count(), mask.words.data(),
                               mask.strips, place.x, place.y);
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

// Cells of a row of the whole mask that are occupied in a class in which they may be covered.
std::uint64_t SweepChecker::hitsOf(const Place& place, int row, int strip) const {
  const SweepMask& mask = *place.mask;
  const int mask_row = mask.any.first_row + row;
  std::uint64_t hits = 0;
  for (int c = 0; c < classes_->count(); ++c) {
    const SweepMask::Layer& layer = mask.outer[c];
    const int own_row = mask_row - layer.first_row;
    if (own_row < 0 || own_row >= layer.rows) continue;
    const std::uint64_t covered = mask.words[layer.offset + strip * layer.rows + own_row];
    if (covered == 0) continue;
    hits |= covered & around_->occupied.word(c, place.x + strip * kBits, place.y + mask_row);
  }
  return hits;
}

bool SweepChecker::touchesHitCells(const Sweep& sweep, const Pose2& map_T_start,
                                   const Place& place) const {
  const SweepMask& mask = *place.mask;
  const CollisionChecker::Columns& map = checker_.data_->map->columns;
  const CollisionChecker::Columns& around = checker_.columns();
  const Pose2 start_T_map = map_T_start.inverse();
  bool outside = false;
  bool solids = false;
  for (int row = 0; row < mask.any.rows; ++row) {
    const int y = place.y + mask.any.first_row + row;
    for (int strip = 0; strip < mask.strips; ++strip) {
      const int x0 = place.x + strip * kBits;
      for (std::uint64_t hits = hitsOf(place, row, strip); hits != 0; hits &= hits - 1) {
        const int x = x0 + __builtin_ctzll(hits);
        if (x < 0 || y < 0 || x >= map.width || y >= map.height) {
          outside = true;
          continue;
        }
        const std::size_t column = static_cast<std::size_t>(y) * map.width + x;
        const Eigen::Vector2d corner = map.origin_m + map.resolution_m * Eigen::Vector2d(x, y);
        const Shadow square =
            transformed(start_T_map, rectangle(corner, corner.array() + map.resolution_m));
        if (map.bits[column] != 0 && touchesCell(sweep, square, column)) return true;
        solids = solids || around.bits[column] != map.bits[column];
      }
    }
  }
  return (outside || solids) && touchesRest(sweep, map_T_start, outside, solids);
}

bool SweepChecker::touchesCell(const Sweep& sweep, const Shadow& start_square,
                               std::size_t column) const {
  const MapColumns& map = *checker_.data_->map;
  const Eigen::Vector2d centre = (start_square.points[0] + start_square.points[2]) / 2.0;
  Shadow square;
  square.count = start_square.count;
  for (std::size_t t = 0; t < sweep.tracks().size(); ++t) {
    const Footprint& body = *sweep.tracks()[t].body;
    const double near_m = body.reach() + map.columns.resolution_m * M_SQRT1_2;
    for (const Sweep::Stop& stop : sweep.stops(t)) {
      if ((stop.position_m - centre).squaredNorm() > near_m * near_m) continue;
      for (int i = 0; i < square.count; ++i) {
        const Eigen::Vector2d offset = start_square.points[i] - stop.position_m;
        square.points[i] = {stop.cosine * offset.x() + stop.sine * offset.y(),
                            stop.cosine * offset.y() - stop.sine * offset.x()};
      }
      if (reachesInto(body, square, map, column)) return true;
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
