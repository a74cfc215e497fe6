#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/geometry.h"
#include "casepush/model/load.h"

namespace casepush {

/// Walls and furniture that never move.
struct StaticBox {
  std::string name;
  Box box;
  Eigen::Isometry3d map_T_box = Eigen::Isometry3d::Identity();
};

/// The floor's part in friction and rolling resistance.
struct Floor {
  double friction = 0.8;                ///< Coulomb coefficient of a wheel's contact.
  double rolling_lever_arm_m = 0.0024;  ///< f of F = f N / r (Al-Eisawi et al. 1999: tile).
};

/// A scan of a place: its points between two heights are static.
struct PointCloudFile {
  std::filesystem::path file;  ///< .pcd or .xyz, in the map frame [m].
  double resolution_m = 0.05;  ///< Edge of the cells that points fill.
  double low_m = 0.05;         ///< Points below are the floor,
  double high_m = 2.0;         ///< and points above the ceiling.
};

/// One pushable object in a world.
struct ObjectPlacement {
  std::string id;     ///< Unique in the world, e.g. "chair_1"; see checkObjectId().
  std::string model;  ///< Name or file of an ObjectModel.
  Pose2 map_T_object;
  int tag_offset = 0;  ///< Added to every tag id of the model, so that instances differ.
  std::optional<Load> load = std::nullopt;  ///< What lies on it at the start.
};

/// @throws InputError at `where` unless the id is 1 to 64 letters, digits, '_', '-' or '.', the
/// first a letter or digit: it becomes part of topics, files, and lines of text.
void checkObjectId(const std::string& id, const std::string& where);

/// A room: YAML file of config/worlds. Its map frame has z = 0 on the floor.
struct WorldModel {
  std::string name;
  std::string file;                   ///< It was read from; empty if it was made otherwise.
  Eigen::Vector2d min_m{-5.0, -5.0};  ///< Bounds of the map.
  Eigen::Vector2d max_m{5.0, 5.0};
  Floor floor;
  std::vector<StaticBox> boxes;
  /// An OctoMap file whose occupied space is static, too; world/static_map.h makes boxes of it.
  std::optional<std::filesystem::path> static_map;
  std::optional<PointCloudFile> point_cloud;  ///< The same for a point cloud.

  /// True while static_map or point_cloud still wait to be made boxes of.
  bool hasUnreadMap() const { return static_map || point_cloud; }

  std::vector<ObjectPlacement> objects;
  std::string robot = "cobot";  ///< Name or file of a RobotModel.
  Pose2 map_T_robot;
  std::optional<Pose2> goal;  ///< Of the first object, for demonstrations.

  bool contains(const Pose2& map_T_x) const;
  std::string where() const;  ///< For messages: its file, or else "world" and its name.
};

/// @throws InputError naming file, element and reason; also if an object or the robot stands
/// outside.
WorldModel loadWorldModel(const std::filesystem::path& yaml_file);

/// The world in the format that loadWorldModel reads. What it reads from there is equal to `world`
/// to the last bit, apart from the name, which is the file's, if angles came from degrees: from a
/// file, or as `degrees * (pi / 180)`; other angles within 1e-12 rad.
/// @pre Boxes are upright.
std::string worldYaml(const WorldModel& world);

/// Writes worldYaml(); whoever opens the file finds the old content or the new one.
/// @throws InputError if the file cannot be written; the old one is then as it was.
void saveWorldModel(const WorldModel& world, const std::filesystem::path& yaml_file);

}  // namespace casepush
