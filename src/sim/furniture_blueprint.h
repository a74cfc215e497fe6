#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casepush/model/object_model.h"
#include "collision.h"
#include "mass_properties.h"

namespace casepush::sim {

/// Wheels yield this much under an even share of the weight.
constexpr double kWheelSink_m = 2e-5;

/// Links of an object that are rigidly joined, as one body of the Featherstone tree.
struct BodyBlueprint {
  int parent = -1;  ///< Index of the parent body; -1 for the base, which is body 0.
  int joint = -1;   ///< Joint of the mechanism that leads here; -1 for the base.
  MassProperties mass;
  Eigen::Vector3d root_pivot_m = Eigen::Vector3d::Zero();  ///< Of the joint, in the root frame.
  Eigen::Vector3d root_axis = Eigen::Vector3d::UnitZ();
  double friction_nm = 0.0;
  int wheel = -1;  ///< Index into the model's casters if this is a wheel.
  bool swivels = false;
  btCollisionShape* shape = nullptr;  ///< nullptr if nothing of it collides.
  CollisionTag tag;
};

/// All of an object that stays the same whenever the world is rebuilt.
struct FurnitureBlueprint {
  std::string id;
  const ObjectModel* model = nullptr;
  std::vector<BodyBlueprint> bodies;
  std::vector<int> body_of_link;              ///< For each link of the mechanism.
  std::vector<Eigen::Isometry3d> com_T_link;  ///< From the body's centre of mass.
  std::vector<double> wheel_radius_m;         ///< For each caster.
  std::optional<Load> load;                   ///< On body 0, with its height.
  double mass_kg = 0.0;                       ///< With the load.

  std::vector<std::unique_ptr<CompoundShape>> compounds;
  std::vector<std::unique_ptr<btCollisionShape>> wheel_shapes;
};

/// @param index  Number of the object in the world.
/// @param load  As placedLoad() gives it; one without mass is none.
/// @throws InputError if nothing of the object can touch the floor.
/// @pre `model` outlives the result.
FurnitureBlueprint makeBlueprint(const std::string& id, int index, const ObjectModel& model,
                                 std::optional<Load> load = std::nullopt);

}  // namespace casepush::sim
