#pragma once

#include <string>
#include <vector>

#include "casepush/model/catalog.h"
#include "casepush/model/world_model.h"
#include "casepush/world/map.h"

namespace casepush {

/// Boxes that fill a map's occupied cells exactly, without overlap, each as large as it greedily
/// gets; few where the map is made of walls and furniture.
///
/// Cells whose top is not above `floor_m` are the floor, as for CollisionChecker; they and cells
/// with their centre outside of [min_m, max_m] are left out. Boxes are named `<name>_1` and so on.
/// @throws InputError naming `name` if the occupied cells spread over more than 2^28 cells.
std::vector<StaticBox> boxesOf(const Map& map, const Eigen::Vector2d& min_m,
                               const Eigen::Vector2d& max_m, const std::string& name,
                               double floor_m = 0.05);

/// The cells that a cloud's points within the bounds and its heights fill.
/// @throws InputError from loadPointCloud().
Map mapOf(const PointCloudFile& cloud, const Eigen::Vector2d& min_m, const Eigen::Vector2d& max_m);

/// The world with its static map and its point cloud, if it has them, turned into boxes.
/// @throws InputError if one of them cannot be read, holds nothing within the world's bounds, or a
/// box
///   of the world has a name like those of the map.
WorldModel withStaticMap(WorldModel world);

/// A world from the catalog with all that stands in it: `withStaticMap(catalog.world(...))`.
WorldModel loadWorld(const Catalog& catalog, const std::string& name_or_file);

}  // namespace casepush
