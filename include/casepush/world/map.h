#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "casepush/model/world_model.h"

namespace octomap {
class OcTree;
}

namespace casepush {

/// One beam of a sensor, in the map.
struct SensorRay {
  Eigen::Vector3f map_end;  ///< Finite.
  bool hit = true;          ///< Something stands at its end.
  float blur_m = 0.0F;      ///< So much of it before its end tells nothing about free space.
};

/// Cells that became occupied or ceased to be.
struct MapChange {
  int cells = 0;
  Eigen::AlignedBox3d where_m;  ///< Around all of them; empty if there are none.

  void extend(const MapChange& other);
};

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

  /// The same for rays of which each says what it tells. A cell in which one of them ends is not
  /// freed by the others. Evidence adds up as log-odds: free space takes three hits to become
  /// occupied, an occupied cell at most nine rays through it to become free; in unknown space
  /// the first ray decides.
  /// @throws InputError for a bad origin.
  /// Cost: proportional to the rays' length in cells.
  MapChange addRays(const Eigen::Vector3f& map_origin, const std::vector<SensorRay>& rays);

  /// Frees those occupied cells that reach into a box for which `is_wrong` holds.
  MapChange clear(const Eigen::AlignedBox3d& map_box,
                  const std::function<bool(const Eigen::AlignedBox3d& map_cell)>& is_wrong);

  /// The cells in which this map differs from an older one.
  /// @pre The same resolution. Cost: proportional to the nodes of both maps.
  MapChange changeSince(const Map& before) const;

  Map copy() const;

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
