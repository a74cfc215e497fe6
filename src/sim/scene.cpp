#include "scene.h"

#include <set>
#include <utility>

#include "bullet_conversions.h"
#include "casepush/common/check.h"
#include "casepush/common/input_error.h"

namespace casepush::sim {
namespace {

const ObjectModel& findModel(const Scene& scene, const ObjectPlacement& placement) {
  const auto found = scene.models.find(placement.model);
  if (found == scene.models.end()) {
    throw InputError(scene.world.where() + ": object " + placement.id,
                     "its model " + placement.model + " was not given");
  }
  return found->second;
}

std::optional<Load> placedOn(const ObjectModel& model, const std::optional<Load>& load,
                             const std::string& where) {
  return load ? std::optional<Load>(placedLoad(*load, model.mechanism, where)) : std::nullopt;
}

void checkIds(const WorldModel& world) {
  std::set<std::string> ids{"robot"};
  for (const StaticBox& box : world.boxes) ids.insert(box.name);
  for (const ObjectPlacement& object : world.objects) {
    checkObjectId(object.id, world.where() + ": object");
    if (!ids.insert(object.id).second) {
      throw InputError(world.where() + ": object " + object.id,
                       "its id is taken; ids of objects, boxes and \"robot\" must differ");
    }
  }
}

}  // namespace

Scene::Scene(WorldModel world_model, RobotModel robot_model,
             std::map<std::string, ObjectModel> object_models)
    : world(std::move(world_model)),
      robot(std::move(robot_model)),
      models(std::move(object_models)),
      robot_blueprint(makeBlueprint(robot)) {
  CASEPUSH_CHECK(!world.hasUnreadMap(), "world " << world.name << " lacks its static map");
  checkIds(world);
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const ObjectPlacement& placement = world.objects[i];
    const ObjectModel& model = findModel(*this, placement);
    const std::string where = world.where() + ": object " + placement.id + ": load";
    furniture.push_back(makeBlueprint(placement.id, static_cast<int>(i), model,
                                      placedOn(model, placement.load, where)));
    for (TagMount mount : model.tags) {
      mount.id += placement.tag_offset;
      tags.push_back({static_cast<int>(i), mount});
    }
  }
  for (const StaticBox& box : world.boxes) {
    StaticBlueprint blueprint{toBullet(box.map_T_box), makeShape(box.box), {}};
    blueprint.tag.kind = CollisionTag::Kind::kStatic;
    blueprint.tag.body = box.name;
    blueprint.tag.parts = {box.name};
    boxes.push_back(std::move(blueprint));
  }
}

FurnitureBlueprint Scene::setLoad(int object, const std::optional<Load>& load,
                                  const std::string& where) {
  FurnitureBlueprint& blueprint = furniture[static_cast<std::size_t>(object)];
  const ObjectModel& model = *blueprint.model;
  return std::exchange(blueprint,
                       makeBlueprint(blueprint.id, object, model, placedOn(model, load, where)));
}

int Scene::objectIndex(const std::string& id) const {
  for (std::size_t i = 0; i < furniture.size(); ++i) {
    if (furniture[i].id == id) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace casepush::sim
