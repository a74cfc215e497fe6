#include "casepush/world/map_file.h"

#include <octomap/OcTree.h>

#include <cmath>

#include "casepush/common/input_error.h"
#include "casepush/world/static_map.h"
#include "cell_cover.h"
#include "map_stream.h"

namespace casepush {
namespace {

constexpr double kDefaultResolution_m = 0.05;
constexpr double kMostPoints = 5e7;
constexpr double kFar_m = 1e6;

}  // namespace

Map resampled(const Map& map, double resolution_m) {
  checkResolution(resolution_m, "map");
  std::vector<Eigen::Vector3f> points;
  if (!map.empty()) {
    addFloorRim(map.min().head<2>(), map.max().head<2>(), resolution_m, &points);
  }
  for (const Map::Voxel& voxel : map.occupied()) {
    const Eigen::Array3d centre = voxel.centre_m.cast<double>().array();
    const double half_m = voxel.size_m / 2.0 - kSkin_m;
    const Eigen::Array3i low = ((centre - half_m) / resolution_m).floor().cast<int>();
    const Eigen::Array3i high = ((centre + half_m) / resolution_m).floor().cast<int>();
    const double added = (high - low + 1).cast<double>().prod();
    if (static_cast<double>(points.size()) + added > kMostPoints) {
      throw InputError("map", "would have more than 50 million cells; use a coarser resolution");
    }
    for (int x = low.x(); x <= high.x(); ++x) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int z = low.z(); z <= high.z(); ++z) {
          points.push_back(cellCentre(x, y, z, resolution_m));
        }
      }
    }
  }
  Map result(resolution_m);
  result.addSurvey(points);
  return result;
}

Map loadMap(const std::filesystem::path& file, const MapFileOptions& options) {
  const std::string extension = file.extension().string();
  const double resolution_m = options.resolution_m.value_or(kDefaultResolution_m);
  if (extension == ".yaml" || extension == ".yml") {
    return mapOf(loadOccupancyGrid(file), options.occupancy, resolution_m, file.string());
  }
  if (extension == ".pcd" || extension == ".xyz") {
    checkResolution(resolution_m, file.string());
    const PointCloudFile cloud{file, resolution_m, options.low_m, options.high_m};
    const Eigen::Vector2d all(kFar_m, kFar_m);
    Map map = mapOf(cloud, -all, all);
    if (map.empty()) {
      throw InputError(file.string(), "holds no point between the heights that count");
    }
    return map;
  }
  Map map = Map::load(file);
  const bool as_it_is =
      !options.resolution_m || std::abs(*options.resolution_m - map.resolution()) < 1e-9;
  return as_it_is ? std::move(map) : resampled(map, resolution_m);
}

MapSize sizeOf(const Map& map) {
  MapSize size;
  const octomap::OcTree& tree = map.tree();
  size.nodes = tree.size();
  size.memory_bytes = tree.memoryUsage();
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    ++size.leaves;
    const double volume_m3 = std::pow(leaf.getSize(), 3);
    if (tree.isNodeOccupied(*leaf)) {
      ++size.occupied_leaves;
      size.occupied_m3 += volume_m3;
    } else {
      size.free_m3 += volume_m3;
    }
  }
  return size;
}

}  // namespace casepush
