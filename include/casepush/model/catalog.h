#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"
#include "casepush/model/world_model.h"

namespace casepush {

/// Finds objects, robots and worlds by name (in `<share>/config`) or by file.
class Catalog {
 public:
  /// `share` is the folder that holds `config/`.
  explicit Catalog(std::filesystem::path share);

  /// The package's own folder; the environment variable CASEPUSH_SHARE overrides it.
  static Catalog standard();

  /// @throws InputError if there is no such name (listing those there are) or the file is bad.
  ObjectModel object(const std::string& name_or_file) const;
  RobotModel robot(const std::string& name_or_file) const;
  WorldModel world(const std::string& name_or_file) const;

  /// Every kind of object that a world holds, by the name or file that the world uses.
  /// @throws InputError as object() does, naming the world and its element, too.
  std::map<std::string, ObjectModel> objectsOf(const WorldModel& world) const;
  /// The same, by the model's own name.
  std::map<std::string, ObjectModel> objectsIn(const WorldModel& world) const;
  /// @throws InputError as robot() does, naming the world, too.
  RobotModel robotOf(const WorldModel& world) const;

  std::vector<std::string> objectNames() const;
  std::vector<std::string> robotNames() const;
  std::vector<std::string> worldNames() const;

  const std::filesystem::path& share() const { return share_; }

 private:
  std::filesystem::path find(const std::string& kind, const std::string& extension,
                             const std::string& name_or_file) const;
  std::vector<std::string> names(const std::string& kind, const std::string& extension) const;

  std::filesystem::path share_;
};

/// Sees to it that a world holds an object, and returns the id of that instance.
///
/// `object` is an id in the world, or an object by name or file. If the world holds none of that
/// kind, it takes the place of the first object, as `<name>_1`. Empty: the first object of the
/// world.
/// @throws InputError if the world holds no object, or the object is unknown or bad.
std::string placeObject(WorldModel& world, const Catalog& catalog, const std::string& object);

}  // namespace casepush
