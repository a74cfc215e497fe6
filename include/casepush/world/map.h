#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "casepush/model/world_model.h"

namespace octomap {
class OcTree;
}

namespace casepush {

/// The static structure of a place: an OctoMap in the map frame, z = 0 on the floor.
class Map {
 public:
  /// An empty map. @throws InputError unless resolution is in [0.01, 0.5] m.
  explicit Map(double resolution_m);
  ~Map();
  Map(Map&&) noexcept;
  Map& operator=(Map&&) noexcept;

  /// Reads a .bt or .ot file. @throws InputError if missing, truncated, empty or not an OcTree.
  static Map load(const std::filesystem::path& file);

  /// From OctoMap's binary stream (as in a message); no bytes are an empty map.
  /// @throws InputError if they are truncated or damaged.
  static Map fromBinary(double resolution_m, const std::vector<std::int8_t>& data);
  std::vector<std::int8_t> toBinary() const;

  /// Writes a .bt file. @throws InputError if it cannot be written.
  void save(const std::filesystem::path& file) const;

  /// Marks points as occupied, without free space in between (a survey, or a model of the room).
  /// @throws InputError if a point is not finite or too far away; the map is then unchanged.
  void addSurvey(const std::vector<Eigen::Vector3f>& map_points);

  /// Casts rays from a sensor: free along them, occupied at their ends. Points that are not finite
  /// (no return) are ignored. @throws InputError for a bad origin or range.
  void addScan(const Eigen::Vector3f& map_origin, const std::vector<Eigen::Vector3f>& map_points,
               double max_range_m);

  double resolution() const;
  bool empty() const;

  /// Centres and edge lengths of the occupied leaves.
  struct Voxel {
    Eigen::Vector3f centre_m;
    float size_m;
  };
  std::vector<Voxel> occupied() const;

  /// Axis-aligned bounds of everything known. @pre not empty().
  Eigen::Vector3d min() const;
  Eigen::Vector3d max() const;

  const octomap::OcTree& tree() const { return *tree_; }

 private:
  explicit Map(std::unique_ptr<octomap::OcTree> tree);
  std::unique_ptr<octomap::OcTree> tree_;
};

/// Points from which Map::addSurvey makes a map, of the same resolution, of all that stands in a
/// world.
///
/// They are the centres of all cells into which a box reaches by more than 1 mm, the inside
/// included, so that what does not collide with the map does not collide with the boxes. The
/// floor's rim, one layer of cells below z = 0, makes the world's bounds the map's.
/// @throws InputError unless resolution is in [0.01, 0.5] m, and naming the world if it spans more
///   than 4096 cells along an axis or its boxes would fill more than 50 million.
std::vector<Eigen::Vector3f> surveyPoints(const WorldModel& world, double resolution_m);

}  // namespace casepush
