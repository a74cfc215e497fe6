#include "casepush/world/collision_checker.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "casepush/common/check.h"
#include "footprint.h"
#include "map_columns.h"
#include "slab.h"

namespace casepush {
namespace {

/// An obstacle's parts, ready for pair tests.
struct Obstacle {
  std::vector<ConvexPart> parts;
  double reach_m = 0.0;
};

/// Solids around, shared by copies of a checker.
struct Surroundings {
  std::vector<PlacedSolid> placed;
  std::vector<Obstacle> prepared;
  CollisionChecker::Columns columns;  ///< Of map and solids.
};

Eigen::Vector2d columnCorner(const CollisionChecker::Columns& columns, std::size_t column) {
  const Eigen::Vector2d cell(static_cast<double>(column % columns.width),
                             static_cast<double>(column / columns.width));
  return columns.origin_m + columns.resolution_m * cell;
}

/// A footprint at a pose. Cells are compared in the solid's own frame, where its shadows are ready.
class PlacedFootprint {
 public:
  PlacedFootprint(const Footprint& footprint, const Pose2& map_T_solid)
      : footprint_(footprint), map_T_solid_(map_T_solid), solid_T_map_(map_T_solid.inverse()) {}

  /// How deep the grown solid reaches into the occupied cells of a column of the map; 0 if not.
  double depthIn(const MapColumns& map, std::size_t column) const {
    const double resolution_m = map.columns.resolution_m;
    const Eigen::Vector2d corner = columnCorner(map.columns, column);
    const Shadow square =
        transformed(solid_T_map_, rectangle(corner, corner.array() + resolution_m));
    const Eigen::Vector2d centre = (square.points[0] + square.points[2]) / 2.0;
    double depth = 0.0;
    for (const ConvexPart& part : footprint_.parts()) {
      const double discs_m = part.disc().radius_m + footprint_.margin() + resolution_m * M_SQRT1_2;
      if ((part.disc().centre_m - centre).squaredNorm() > discs_m * discs_m) continue;
      for (std::uint32_t run = map.first_run[column]; run < map.first_run[column + 1]; ++run) {
        depth = std::max(depth, depthIn(square, part, map.runs[run].low * resolution_m,
                                        map.runs[run].high * resolution_m));
      }
    }
    return depth > kContactTolerance_m ? depth : 0.0;
  }

  /// How far the grown solid reaches out of the rectangle; 0 if not.
  double depthOutside(const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m) const {
    double depth = 0.0;
    for (const ConvexPart& part : footprint_.parts()) {
      Eigen::Vector2d low;
      Eigen::Vector2d high;
      shadowBounds(transformed(map_T_solid_, part.shadow()), &low, &high);
      const double beyond = std::max((min_m - low).maxCoeff(), (high - max_m).maxCoeff());
      depth = std::max(depth, beyond + footprint_.margin());
    }
    return depth > kContactTolerance_m ? depth : 0.0;
  }

 private:
  double depthIn(const Shadow& square, const ConvexPart& part, double low_m, double high_m) const {
    if (!part.touches(low_m, high_m)) return 0.0;
    const double margin_m = footprint_.margin();
    if (!closerThan(part.shadow(), square, margin_m - kContactTolerance_m)) return 0.0;
    if (part.isPrism()) return margin_m - separation(part.shadow(), square);
    const Shadow between = part.shadow(low_m, high_m);
    return between.empty() ? 0.0 : margin_m - separation(between, square);
  }

  const Footprint& footprint_;
  Pose2 map_T_solid_;
  Pose2 solid_T_map_;
};

/// Calls `visit(column index)` for the columns that the mask test hits until it returns true.
template <typename Visit>
bool visitHits(const CollisionChecker::Columns& columns, const Footprint& footprint,
               const Pose2& pose, Visit visit) {
  const Eigen::Vector2d offset = (pose.position() - columns.origin_m) / columns.resolution_m;
  const int reach = footprint.reachCells();
  if (!(offset.array() > -reach - 1.0).all() || offset.x() > columns.width + reach + 1.0 ||
      offset.y() > columns.height + reach + 1.0) {
    return false;
  }
  const int ix = static_cast<int>(std::floor(offset.x()));
  const int iy = static_cast<int>(std::floor(offset.y()));
  const bool within =
      ix >= reach && iy >= reach && ix + reach < columns.width && iy + reach < columns.height;
  const std::ptrdiff_t centre = static_cast<std::ptrdiff_t>(iy) * columns.width + ix;
  const std::uint64_t* bits = columns.bits.data();
  for (const Footprint::Entry& entry : footprint.entries(pose.yaw())) {
    const std::ptrdiff_t index = centre + std::ptrdiff_t{entry.dy} * columns.width + entry.dx;
    if (!within) {
      const int x = ix + entry.dx;
      const int y = iy + entry.dy;
      if (x < 0 || y < 0 || x >= columns.width || y >= columns.height) continue;
    }
    if ((bits[index] & entry.slices) != 0 && visit(static_cast<std::size_t>(index))) return true;
  }
  return false;
}

/// Deepest overlap of the footprint with a part of the obstacle; `part` names it.
double depthInObstacle(const Footprint& footprint, const Pose2& map_T_solid,
                       const Obstacle& obstacle, const Pose2& map_T_obstacle, std::string* part) {
  double deepest = 0.0;
  for (const ConvexPart& theirs : obstacle.parts) {
    for (const ConvexPart& ours : footprint.parts()) {
      const double depth =
          overlapDepth(ours, map_T_solid, theirs, map_T_obstacle, footprint.margin());
      if (depth <= deepest) continue;
      deepest = depth;
      if (part == nullptr) return deepest;
      *part = theirs.name();
    }
  }
  return deepest;
}

}  // namespace

struct CollisionChecker::Data {
  std::shared_ptr<const MapColumns> map;
  std::shared_ptr<const Surroundings> around;

  bool mayReachOut(const Footprint& footprint, const Pose2& pose) const {
    const Eigen::Array2d p = pose.position().array();
    return (p - footprint.reach() < map->min_m.array()).any() ||
           (p + footprint.reach() > map->max_m.array()).any();
  }
  bool mayTouch(const Footprint& footprint, const Pose2& pose, std::size_t obstacle) const {
    const double reach = footprint.reach() + around->prepared[obstacle].reach_m;
    const Eigen::Vector2d offset =
        around->placed[obstacle].map_T_solid.position() - pose.position();
    return offset.squaredNorm() < reach * reach;
  }
};

CollisionChecker::CollisionChecker(const Map& map, double floor_m)
    : data_(std::make_unique<Data>()) {
  data_->map = std::make_shared<MapColumns>(map, floor_m);
  setObstacles({});
}

CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker::CollisionChecker(const CollisionChecker& other)
    : data_(std::make_unique<Data>(*other.data_)) {}

std::shared_ptr<const Footprint> CollisionChecker::footprint(const Solid& solid,
                                                             double margin_m) const {
  const Columns& columns = data_->map->columns;
  return std::make_shared<Footprint>(solid, margin_m, columns.resolution_m, columns.slice_m);
}

void CollisionChecker::setObstacles(std::vector<PlacedSolid> obstacles) {
  auto around = std::make_shared<Surroundings>();
  if (!obstacles.empty()) around->columns = data_->map->columns;
  for (const PlacedSolid& placed : obstacles) {
    CASEPUSH_CHECK(placed.map_T_solid.isFinite(), placed.name);
    Obstacle obstacle;
    obstacle.parts = convexParts(placed.solid);
    for (const ConvexPart& part : obstacle.parts) {
      obstacle.reach_m = std::max(obstacle.reach_m, part.reach());
    }
    around->prepared.push_back(std::move(obstacle));
    rasterise(placed, &around->columns);
  }
  around->placed = std::move(obstacles);
  data_->around = std::move(around);
}

const std::vector<PlacedSolid>& CollisionChecker::obstacles() const {
  return data_->around->placed;
}

bool CollisionChecker::collides(const Footprint& footprint, const Pose2& map_T_solid) const {
  CASEPUSH_CHECK(footprint.resolution() == data_->map->columns.resolution_m,
                 footprint.resolution() << " m, map " << data_->map->columns.resolution_m << " m");
  if (!map_T_solid.isFinite()) return true;
  const MapColumns& map = *data_->map;
  const PlacedFootprint placed(footprint, map_T_solid);
  if (data_->mayReachOut(footprint, map_T_solid) &&
      placed.depthOutside(map.min_m, map.max_m) > 0.0) {
    return true;
  }
  const bool hits_map = visitHits(map.columns, footprint, map_T_solid, [&](std::size_t column) {
    return placed.depthIn(map, column) > 0.0;
  });
  if (hits_map) return true;
  for (std::size_t i = 0; i < data_->around->placed.size(); ++i) {
    if (!data_->mayTouch(footprint, map_T_solid, i)) continue;
    const Pose2& map_T_obstacle = data_->around->placed[i].map_T_solid;
    if (depthInObstacle(footprint, map_T_solid, data_->around->prepared[i], map_T_obstacle,
                        nullptr) > 0.0) {
      return true;
    }
  }
  return false;
}

std::vector<Contact> CollisionChecker::contacts(const Footprint& footprint,
                                                const Pose2& map_T_solid) const {
  CASEPUSH_CHECK(map_T_solid.isFinite(), "pose is not finite");
  const MapColumns& map = *data_->map;
  const PlacedFootprint placed(footprint, map_T_solid);
  std::vector<Contact> contacts;
  Contact outside;
  outside.with = Contact::With::kOutside;
  outside.where_m = map_T_solid.position();
  outside.depth_m = placed.depthOutside(map.min_m, map.max_m);
  Contact cell;
  visitHits(map.columns, footprint, map_T_solid, [&](std::size_t column) {
    const double depth = placed.depthIn(map, column);
    if (depth > cell.depth_m) {
      cell.depth_m = depth;
      cell.where_m = columnCorner(map.columns, column).array() + map.columns.resolution_m / 2.0;
    }
    return false;
  });
  if (cell.depth_m > 0.0) contacts.push_back(cell);
  for (std::size_t i = 0; i < data_->around->placed.size(); ++i) {
    if (!data_->mayTouch(footprint, map_T_solid, i)) continue;
    const Pose2& map_T_obstacle = data_->around->placed[i].map_T_solid;
    Contact contact;
    contact.with = Contact::With::kObstacle;
    contact.obstacle = static_cast<int>(i);
    contact.where_m = map_T_obstacle.position();
    contact.depth_m = depthInObstacle(footprint, map_T_solid, data_->around->prepared[i],
                                      map_T_obstacle, &contact.part);
    if (contact.depth_m > 0.0) contacts.push_back(contact);
  }
  if (outside.depth_m > 0.0) contacts.push_back(outside);
  return contacts;
}

bool CollisionChecker::maskHits(const Footprint& footprint, const Pose2& map_T_solid) const {
  return visitHits(data_->map->columns, footprint, map_T_solid, [](std::size_t) { return true; });
}

bool CollisionChecker::isInside(const Pose2& map_T_x) const {
  const Eigen::Array2d p = map_T_x.position().array();
  return data_->map->columns.width > 0 && (p >= data_->map->min_m.array()).all() &&
         (p <= data_->map->max_m.array()).all();
}

const CollisionChecker::Columns& CollisionChecker::columns() const {
  return data_->around->placed.empty() ? data_->map->columns : data_->around->columns;
}

std::shared_ptr<const CollisionChecker::Columns> CollisionChecker::mapColumns() const {
  return {data_->map, &data_->map->columns};
}

std::string describe(const Contact& contact, const std::vector<PlacedSolid>& obstacles) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2);
  const Eigen::Vector2d& at = contact.where_m;
  switch (contact.with) {
    case Contact::With::kOutside:
      return "the outside of the map";
    case Contact::With::kMap:
      text << "the map near (" << at.x() << ", " << at.y() << ")";
      break;
    case Contact::With::kObstacle: {
      const std::string& name = obstacles.at(contact.obstacle).name;
      if (name.empty()) {
        text << "an obstacle at (" << at.x() << ", " << at.y() << ")";
      } else {
        text << name;
      }
      if (!contact.part.empty()) text << " (" << contact.part << ")";
      break;
    }
  }
  return text.str();
}

bool solidsOverlap(const Solid& a, const Pose2& map_T_a, const Solid& b, const Pose2& map_T_b) {
  const std::vector<ConvexPart> parts_b = convexParts(b);
  for (const ConvexPart& part_a : convexParts(a)) {
    for (const ConvexPart& part_b : parts_b) {
      const double reach = part_a.reach() + part_b.reach();
      if ((map_T_a.position() - map_T_b.position()).norm() >= reach) continue;
      if (overlapDepth(part_a, map_T_a, part_b, map_T_b, 0.0) > 0.0) return true;
    }
  }
  return false;
}

}  // namespace casepush
