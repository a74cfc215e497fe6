#include "casepush/world/collision_checker.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "casepush/common/check.h"
#include "checker_data.h"
#include "footprint.h"
#include "placed_footprint.h"
#include "slab.h"

namespace casepush {
namespace {

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

}  // namespace

CollisionChecker::CollisionChecker(const Map& map, double floor_m)
    : data_(std::make_unique<Data>()) {
  data_->map = std::make_shared<MapColumns>(map, floor_m);
  setObstacles({});
}

CollisionChecker CollisionChecker::updated(const Map& map, const Area& changed) const {
  CASEPUSH_CHECK(map.resolution() == data_->map->columns.resolution_m,
                 map.resolution() << " m, before " << data_->map->columns.resolution_m << " m");
  CollisionChecker result(*this);
  result.data_->map = std::make_shared<MapColumns>(map, *data_->map, changed);
  result.setObstacles(obstacles());
  return result;
}

CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;
CollisionChecker::CollisionChecker(const CollisionChecker& other)
    : data_(std::make_unique<Data>(*other.data_)) {}

std::shared_ptr<const Footprint> CollisionChecker::footprint(const Solid& solid,
                                                             double margin_m) const {
  const Columns& columns = data_->map->columns;
  return std::make_shared<Footprint>(solid, margin_m, columns.resolution_m, columns.slice_m);
}

void CollisionChecker::setObstacles(std::vector<PlacedSolid> obstacles) {
  data_->around = std::make_shared<Surroundings>(std::move(obstacles));
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
  return data_->overlapsObstacle(footprint, map_T_solid);
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
  return data_->around->columnsOn(*data_->map);
}

std::shared_ptr<const CollisionChecker::Columns> CollisionChecker::mapColumns() const {
  return {data_->map, &data_->map->columns};
}

CellBox CollisionChecker::Columns::cellsIn(const Area& area) const {
  // An area that ends on a cell's border, but for rounding, does not mean the cell beyond.
  constexpr double kRounding = 1e-6;
  const double scale = 1.0 / resolution_m;
  const Eigen::Vector2d low = (area.min_m - origin_m) * scale;
  const Eigen::Vector2d high = (area.max_m - origin_m) * scale;
  const auto index = [](double at, int count) {
    return static_cast<int>(std::clamp(at, -1.0, static_cast<double>(count)));
  };
  return {std::max(0, index(std::floor(low.x() + kRounding), width)),
          std::min(width - 1, index(std::ceil(high.x() - kRounding) - 1.0, width)),
          std::max(0, index(std::floor(low.y() + kRounding), height)),
          std::min(height - 1, index(std::ceil(high.y() - kRounding) - 1.0, height))};
}

bool CollisionChecker::Columns::hasSameExtent(const Columns& other) const {
  return origin_m == other.origin_m && resolution_m == other.resolution_m && width == other.width &&
         height == other.height;
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
