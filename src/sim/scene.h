#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"
#include "casepush/model/world_model.h"
#include "collision.h"
#include "furniture_blueprint.h"
#include "robot_base.h"

namespace casepush::sim {

struct StaticBlueprint {
  btTransform map_T_box;
  std::unique_ptr<btConvexInternalShape> shape;
  CollisionTag tag;
};

/// A tag as mounted in this world.
struct SceneTag {
  int object = 0;  ///< Index of the object.
  TagMount mount;  ///< Its id includes the object's offset.
};

/// All of a world that stays the same whenever it is rebuilt: shapes, masses, names. Only setLoad
/// changes it.
struct Scene {
  /// @throws InputError if an id is bad or used twice, a model is missing or unusable, or an object
  /// cannot carry its load.
  Scene(WorldModel world, RobotModel robot, std::map<std::string, ObjectModel> models);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  int objectIndex(const std::string& id) const;  ///< -1 if there is none.

  /// Returns the former blueprint, which has to outlive every engine that was made with it.
  /// @throws InputError at `where` if the object cannot carry the load.
  FurnitureBlueprint setLoad(int object, const std::optional<Load>& load, const std::string& where);

  const WorldModel world;
  const RobotModel robot;
  const std::map<std::string, ObjectModel> models;
  RobotBlueprint robot_blueprint;
  std::vector<FurnitureBlueprint> furniture;  ///< In the order of world.objects.
  std::vector<StaticBlueprint> boxes;
  std::vector<SceneTag> tags;
};

}  // namespace casepush::sim
