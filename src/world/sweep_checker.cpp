#include "casepush/world/sweep_checker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/check.h"
#include "checker_data.h"
#include "height_classes.h"
#include "mask_test.h"
#include "placed_footprint.h"
#include "slab.h"
#include "sweep_hulls.h"
#include "turned_bitmaps.h"

namespace casepush {
namespace {

constexpr int kMaxReachCells = 1024;
constexpr int kBits = LayeredBitmap::kBits;

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

CellIndex cellOf(const CollisionChecker::Columns& columns, std::size_t column) {
  return {static_cast<int>(column % columns.width), static_cast<int>(column / columns.width)};
}

}  // namespace

/// What is occupied in each class of heights; one more layer holds all of them.
struct SweepChecker::Images {
  TurnedBitmaps occupied;
  TurnedBitmaps filled;  ///< Of the map alone: through the whole height of some slice.
  Eigen::Vector2d origin_m{0.0, 0.0};
  double cells_per_m = 0.0;
  double reach_m = 0.0;  ///< Sweeps that reach farther might leave the border.

  void clear(const CellBox& box) {
    for (TurnedBitmaps* image : {&occupied, &filled}) {
      for (int y = box.y0; y <= box.y1; ++y) {
        for (int x = box.x0; x <= box.x1; ++x) {
          for (int layer = 0; layer < image->image(0).layers(); ++layer) {
            image->set(layer, {x, y}, false);
          }
        }
      }
    }
  }

  void add(const HeightClasses& classes, CellIndex cell, std::uint64_t slices) {
    for (int c = 0; c < classes.count(); ++c) {
      if ((slices & classes.slices(c)) == 0) continue;
      occupied.set(c, cell);
      occupied.set(classes.count(), cell);
    }
  }
};

/// A sweep's mask at the cell of its start, in the image turned by some quarters.
struct SweepChecker::Place {
  const SweepMask* mask = nullptr;
  int quarter = 0;
  CellIndex first;  ///< Of the mask.
};

/// Takes points of the map to the frame where a motion starts.
struct SweepChecker::StartFrame {
  explicit StartFrame(const Pose2& map_T_start)
      : position_m(map_T_start.position()),
        cosine(std::cos(map_T_start.yaw())),
        sine(std::sin(map_T_start.yaw())) {}

  Eigen::Vector2d toStart(const Eigen::Vector2d& map_point_m) const {
    const Eigen::Vector2d off = map_point_m - position_m;
    return {cosine * off.x() + sine * off.y(), cosine * off.y() - sine * off.x()};
  }

  Eigen::Vector2d position_m;
  double cosine;
  double sine;
};

std::shared_ptr<const HeightClasses> SweepChecker::heightClasses(const CollisionChecker& checker,
                                                                 const Bodies& bodies) {
  return std::make_shared<HeightClasses>(bodies, *checker.mapColumns());
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
  images->origin_m = map.columns.origin_m;
  images->cells_per_m = 1.0 / map.columns.resolution_m;
  images->reach_m = (border - kBits - 2.0) * map.columns.resolution_m;
  images->occupied = TurnedBitmaps(classes_->count() + 1, width, height, border);
  images->filled = TurnedBitmaps(classes_->count(), width, height, border);
  draw(map, {0, width - 1, 0, height - 1}, images.get());
  map_ = std::move(images);
  *this = withObstaclesOf(checker_);
}

// Draws cells of the map anew.
void SweepChecker::draw(const MapColumns& map, const CellBox& box, Images* images) const {
  for (int y = box.y0; y <= box.y1; ++y) {
    for (int x = box.x0; x <= box.x1; ++x) {
      const std::size_t column = static_cast<std::size_t>(y) * map.columns.width + x;
      const std::uint64_t slices = map.columns.bits[column];
      if (slices == 0) continue;
      images->add(*classes_, {x, y}, slices);
      const std::uint64_t filled = filledSlices(map, column);
      for (int c = 0; c < classes_->count(); ++c) {
        if ((filled & classes_->slices(c)) != 0) images->filled.set(c, {x, y});
      }
    }
  }
}

SweepChecker SweepChecker::updated(CollisionChecker checker,
                                   const CollisionChecker::Area& changed) const {
  const MapColumns& before = *checker_.data_->map;
  const MapColumns& now = *checker.data_->map;
  if (now.min_m != before.min_m || now.max_m != before.max_m) {
    // Half a cell less than the whole number of cells that it was rounded up to.
    const double reach_m = map_->reach_m - now.columns.resolution_m / 2.0;
    return SweepChecker(std::move(checker), classes_, reach_m);
  }
  SweepChecker result(*this);
  auto images = std::make_shared<Images>(*map_);
  const CellBox box = now.columns.cellsIn(changed);
  images->clear(box);
  draw(now, box, images.get());
  result.map_ = std::move(images);
  result.checker_ = CollisionChecker(checker);
  return result.withObstaclesOf(std::move(checker));
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
      images->add(*classes_, cellOf(columns, column), slices);
    });
  }
  result.around_ = std::move(images);
  return result;
}

// False if there is no mask, or it might reach beyond the images.
bool SweepChecker::place(const Sweep& sweep, const Pose2& map_T_start, Place* place) const {
  const Images& images = *around_;
  const double x = (map_T_start.x() - images.origin_m.x()) * images.cells_per_m;
  const double y = (map_T_start.y() - images.origin_m.y()) * images.cells_per_m;
  const CellIndex& size = images.occupied.size();
  if (!(x >= 0.0 && y >= 0.0 && x < size.x && y < size.y)) return false;
  if (sweep.reach() > images.reach_m || !std::isfinite(map_T_start.yaw())) return false;
  const Sweep::Turned turned = sweep.mask(map_T_start.yaw());
  if (turned.mask == nullptr) return false;
  place->mask = turned.mask;
  place->quarter = turned.quarters;
  place->first = images.occupied.turn({static_cast<int>(x), static_cast<int>(y)}, turned.quarters);
  place->first.x += place->mask->firstColumn();
  place->first.y += place->mask->firstRow();
  return true;
}

double SweepChecker::reach() const { return map_->reach_m; }

const TurnedBitmaps& SweepChecker::mapImages() const { return map_->occupied; }

std::uint64_t SweepChecker::fingerprint() const {
  return map_->occupied.fingerprint() * 3 + map_->filled.fingerprint() * 5 +
         around_->occupied.fingerprint() * 7;
}

bool SweepChecker::mayCollide(const Sweep& sweep, const Pose2& map_T_start) const {
  Place at;
  if (!place(sweep, map_T_start, &at)) return collidesPoseByPose(sweep, map_T_start);
  return testMask(*at.mask, around_->occupied.image(at.quarter), nullptr, at.first.x, at.first.y) !=
         MaskAnswer::kFree;
}

bool SweepChecker::collides(const Sweep& sweep, const Pose2& map_T_start) const {
  Place at;
  if (!place(sweep, map_T_start, &at)) return collidesPoseByPose(sweep, map_T_start);
  const MaskAnswer answer = testMask(*at.mask, around_->occupied.image(at.quarter),
                                     &map_->filled.image(at.quarter), at.first.x, at.first.y);
  return answer == MaskAnswer::kCertain ||
         (answer == MaskAnswer::kMay && touchesHitCells(sweep, map_T_start, at));
}

bool SweepChecker::certainlyCollides(const Sweep& sweep, const Pose2& map_T_start) const {
  Place at;
  return place(sweep, map_T_start, &at) &&
         testMask(*at.mask, around_->occupied.image(at.quarter), &map_->filled.image(at.quarter),
                  at.first.x, at.first.y) == MaskAnswer::kCertain;
}

// Cells of a tile's row that are occupied in a class in which they may be covered.
std::uint64_t SweepChecker::hitsOf(const Place& place, int tile, int row) const {
  const SweepMask& mask = *place.mask;
  const int x = place.first.x + tile / mask.steps() * kBits;
  const int y = place.first.y + tile % mask.steps() * SweepMask::kTileWords + row;
  const LayeredBitmap& occupied = around_->occupied.image(place.quarter);
  if ((mask.any(tile)[row] & occupied.word(occupied.layers() - 1, x, y)) == 0) return 0;
  std::uint64_t hits = 0;
  const std::uint64_t* line = mask.line(mask.tile(tile).line);
  for (unsigned classes = mask.tile(tile).outer; classes != 0; classes &= classes - 1) {
    hits |= line[row] & occupied.word(__builtin_ctz(classes), x, y);
    line += SweepMask::kTileWords;
  }
  return hits;
}

bool SweepChecker::touchesHitCells(const Sweep& sweep, const Pose2& map_T_start,
                                   const Place& place) const {
  const SweepMask& mask = *place.mask;
  const CollisionChecker::Columns& map = checker_.data_->map->columns;
  const CollisionChecker::Columns& around = checker_.columns();
  const StartFrame start(map_T_start);
  bool outside = false;
  bool solids = false;
  for (int tile = 0; tile < mask.strips() * mask.steps(); ++tile) {
    const int x0 = place.first.x + tile / mask.steps() * kBits;
    for (int row = 0; row < SweepMask::kTileWords; ++row) {
      const int y = place.first.y + tile % mask.steps() * SweepMask::kTileWords + row;
      for (std::uint64_t hits = hitsOf(place, tile, row); hits != 0; hits &= hits - 1) {
        const CellIndex cell =
            around_->occupied.turnBack({x0 + __builtin_ctzll(hits), y}, place.quarter);
        if (cell.x < 0 || cell.y < 0 || cell.x >= map.width || cell.y >= map.height) {
          outside = true;
          continue;
        }
        const std::size_t column = static_cast<std::size_t>(cell.y) * map.width + cell.x;
        if (map.bits[column] != 0 && touchesCell(sweep, start, column)) return true;
        solids = solids || around.bits[column] != map.bits[column];
      }
    }
  }
  return (outside || solids) && touchesRest(sweep, map_T_start, outside, solids);
}

bool SweepChecker::touchesCell(const Sweep& sweep, const StartFrame& start,
                               std::size_t column) const {
  const MapColumns& map = *checker_.data_->map;
  const double side_m = map.columns.resolution_m;
  const Eigen::Vector2d along(start.cosine * side_m, -start.sine * side_m);
  const Eigen::Vector2d across(-along.y(), along.x());
  Shadow square;
  square.count = 4;
  square.points[0] = start.toStart(columnCorner(map.columns, column));
  square.points[1] = square.points[0] + along;
  square.points[2] = square.points[1] + across;
  square.points[3] = square.points[0] + across;
  const SweepHulls::Square place{(square.points[0] + square.points[2]) / 2.0, along / 2.0,
                                 across / 2.0};
  std::uint32_t classes = 0;
  for (int c = 0; c < classes_->count(); ++c) {
    classes |= (map.columns.bits[column] & classes_->slices(c)) != 0 ? 1U << c : 0U;
  }
  const SweepHulls& hulls = sweep.hulls();
  for (const std::uint32_t index : hulls.near(place.centre_m)) {
    const SweepHulls::Hull& hull = hulls.hull(index);
    if ((hull.classes & classes) == 0 || !hulls.mayTouch(hull, place)) continue;
    if (touchesCellWithin(sweep, hull.track, hull.first_pose, hull.last_pose, hull.parts, square,
                          column)) {
      return true;
    }
  }
  return false;
}

bool SweepChecker::touchesCellWithin(const Sweep& sweep, int track, int first_pose, int last_pose,
                                     const std::vector<int>& parts, const Shadow& start_square,
                                     std::size_t column) const {
  const Footprint& body = *sweep.tracks()[track].body;
  const std::vector<Sweep::Stop>& stops = sweep.stops(track);
  Shadow square;
  square.count = start_square.count;
  for (int k = first_pose; k <= last_pose; ++k) {
    const Sweep::Stop& stop = stops[k];
    for (int i = 0; i < square.count; ++i) {
      const Eigen::Vector2d offset = start_square.points[i] - stop.position_m;
      square.points[i] = {stop.cosine * offset.x() + stop.sine * offset.y(),
                          stop.cosine * offset.y() - stop.sine * offset.x()};
    }
    for (const int part : parts) {
      if (partReachesInto(body, part, square, *checker_.data_->map, column)) return true;
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
