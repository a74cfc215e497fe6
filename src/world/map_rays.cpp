#include <octomap/OcTree.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "casepush/common/input_error.h"
#include "casepush/world/map.h"
#include "map_points.h"

namespace casepush {
namespace {

void checkOrigin(const octomap::OcTree& tree, const Eigen::Vector3f& map_origin) {
  octomap::OcTreeKey key;
  if (!map_origin.allFinite() || !tree.coordToKeyChecked(toOctomap(map_origin), key)) {
    throw InputError("map scan",
                     "origin " + describe(map_origin) + " is not finite or too far away");
  }
}

Eigen::AlignedBox3d boxOf(const octomap::OcTree& tree, const octomap::OcTreeKey& key) {
  const octomap::point3d centre = tree.keyToCoord(key);
  const Eigen::Array3d middle(centre.x(), centre.y(), centre.z());
  const double half_m = tree.getResolution() / 2.0;
  return {middle - half_m, middle + half_m};
}

void note(const octomap::OcTree& tree, const octomap::OcTreeKey& key, MapChange* change) {
  ++change->cells;
  change->where_m.extend(boxOf(tree, key));
}

/// Cells by key, to be sorted: a scan has some hundred thousand, which hash sets are slow for.
using PackedKeys = std::vector<std::uint64_t>;

std::uint64_t packed(const octomap::OcTreeKey& key) {
  return std::uint64_t{key[0]} << 32 | std::uint64_t{key[1]} << 16 | key[2];
}

octomap::OcTreeKey unpacked(std::uint64_t key) {
  return {static_cast<octomap::key_type>(key >> 32), static_cast<octomap::key_type>(key >> 16),
          static_cast<octomap::key_type>(key)};
}

void sortUnique(PackedKeys* keys) {
  std::sort(keys->begin(), keys->end());
  keys->erase(std::unique(keys->begin(), keys->end()), keys->end());
}

void update(const octomap::OcTreeKey& key, bool hit, octomap::OcTree* tree, MapChange* change) {
  const octomap::OcTreeNode* before = tree->search(key);
  if (!hit && before != nullptr && before->getLogOdds() <= tree->getClampingThresMinLog()) return;
  const bool was_occupied = before != nullptr && tree->isNodeOccupied(before);
  if (tree->isNodeOccupied(tree->updateNode(key, hit)) != was_occupied) note(*tree, key, change);
}

}  // namespace

void Map::addScan(const Eigen::Vector3f& map_origin, const std::vector<Eigen::Vector3f>& map_points,
                  double max_range_m) {
  checkOrigin(*tree_, map_origin);
  if (!(max_range_m > 0.0)) {
    throw InputError("map scan",
                     "range is " + std::to_string(max_range_m) + " m, must be positive");
  }
  const auto range_m = static_cast<float>(max_range_m);
  std::vector<SensorRay> rays;
  rays.reserve(map_points.size());
  for (const Eigen::Vector3f& point : map_points) {
    if (!point.allFinite()) continue;
    const Eigen::Vector3f offset = point - map_origin;
    const bool hit = offset.norm() <= range_m;
    rays.push_back({hit ? point : map_origin + range_m * offset.normalized(), hit});
  }
  addRays(map_origin, rays);
}

MapChange Map::addRays(const Eigen::Vector3f& map_origin, const std::vector<SensorRay>& rays) {
  checkOrigin(*tree_, map_origin);
  PackedKeys occupied;
  PackedKeys free;
  octomap::KeyRay passed;
  octomap::OcTreeKey key;
  for (const SensorRay& ray : rays) {
    if (ray.hit && tree_->coordToKeyChecked(toOctomap(ray.map_end), key)) {
      occupied.push_back(packed(key));
    }
    const Eigen::Vector3f way = ray.map_end - map_origin;
    const float length_m = way.norm();
    if (!(length_m > ray.blur_m)) continue;
    const Eigen::Vector3f free_end = map_origin + way * ((length_m - ray.blur_m) / length_m);
    if (!tree_->computeRayKeys(toOctomap(map_origin), toOctomap(free_end), passed)) continue;
    for (const octomap::OcTreeKey& cell : passed) free.push_back(packed(cell));
  }
  sortUnique(&occupied);
  sortUnique(&free);
  MapChange change;
  for (const std::uint64_t hit : occupied) update(unpacked(hit), true, tree_.get(), &change);
  for (const std::uint64_t miss : free) {
    if (std::binary_search(occupied.begin(), occupied.end(), miss)) continue;
    update(unpacked(miss), false, tree_.get(), &change);
  }
  return change;
}

MapChange Map::clear(const Eigen::AlignedBox3d& map_box,
                     const std::function<bool(const Eigen::AlignedBox3d&)>& is_wrong) {
  MapChange change;
  octomap::OcTreeKey low;
  octomap::OcTreeKey high;
  const Eigen::Vector3f low_corner = map_box.min().cast<float>();
  const Eigen::Vector3f high_corner = map_box.max().cast<float>();
  if (!tree_->coordToKeyChecked(toOctomap(low_corner), low) ||
      !tree_->coordToKeyChecked(toOctomap(high_corner), high)) {
    return change;
  }
  octomap::OcTreeKey key;
  for (key[0] = low[0]; key[0] <= high[0]; ++key[0]) {
    for (key[1] = low[1]; key[1] <= high[1]; ++key[1]) {
      for (key[2] = low[2]; key[2] <= high[2]; ++key[2]) {
        const octomap::OcTreeNode* node = tree_->search(key);
        if (node == nullptr || !tree_->isNodeOccupied(node)) continue;
        if (!is_wrong(boxOf(*tree_, key))) continue;
        tree_->setNodeValue(key, tree_->getClampingThresMinLog());
        note(*tree_, key, &change);
      }
    }
  }
  return change;
}

}  // namespace casepush
