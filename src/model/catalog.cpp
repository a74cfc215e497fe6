#include "casepush/model/catalog.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr char kUrdf[] = ".urdf";
constexpr char kYaml[] = ".yaml";

}  // namespace

Catalog::Catalog(std::filesystem::path share) : share_(std::move(share)) {
  if (!std::filesystem::is_directory(share_ / "config")) {
    throw InputError(share_.string(),
                     "has no folder config/; set CASEPUSH_SHARE to casepush's share folder");
  }
}

Catalog Catalog::standard() {
  if (const char* share = std::getenv("CASEPUSH_SHARE"); share != nullptr && *share != '\0') {
    return Catalog(share);
  }
  const std::filesystem::path source(CASEPUSH_SOURCE_SHARE);
  return Catalog(std::filesystem::is_directory(source / "config") ? source
                                                                  : CASEPUSH_INSTALL_SHARE);
}

ObjectModel Catalog::object(const std::string& name_or_file) const {
  return loadObjectModel(find("objects", kUrdf, name_or_file));
}

RobotModel Catalog::robot(const std::string& name_or_file) const {
  return loadRobotModel(find("robots", kUrdf, name_or_file));
}

WorldModel Catalog::world(const std::string& name_or_file) const {
  return loadWorldModel(find("worlds", kYaml, name_or_file));
}

std::map<std::string, ObjectModel> Catalog::objectsOf(const WorldModel& world) const {
  std::map<std::string, ObjectModel> models;
  for (const ObjectPlacement& placement : world.objects) {
    if (models.count(placement.model) > 0) continue;
    try {
      models.emplace(placement.model, object(placement.model));
    } catch (const InputError& error) {
      throw InputError(world.where() + ": object " + placement.id + ": model", error.what());
    }
  }
  return models;
}

std::map<std::string, ObjectModel> Catalog::objectsIn(const WorldModel& world) const {
  std::map<std::string, ObjectModel> models;
  for (auto& [name, model] : objectsOf(world)) {
    models.emplace(model.name, model);
  }
  return models;
}

RobotModel Catalog::robotOf(const WorldModel& world) const {
  try {
    return robot(world.robot);
  } catch (const InputError& error) {
    throw InputError(world.where() + ": robot: model", error.what());
  }
}

std::vector<std::string> Catalog::objectNames() const { return names("objects", kUrdf); }
std::vector<std::string> Catalog::robotNames() const { return names("robots", kUrdf); }
std::vector<std::string> Catalog::worldNames() const { return names("worlds", kYaml); }

std::filesystem::path Catalog::find(const std::string& kind, const std::string& extension,
                                    const std::string& name_or_file) const {
  const std::filesystem::path file(name_or_file);
  if (file.has_parent_path() || file.extension() == extension) {
    return file;
  }
  const std::vector<std::string> known = names(kind, extension);
  if (std::find(known.begin(), known.end(), name_or_file) == known.end()) {
    std::string list;
    for (const std::string& name : known) {
      list += (list.empty() ? "" : ", ") + name;
    }
    throw InputError("config/" + kind, "there is none named '" + name_or_file +
                                           "'; known are: " + (list.empty() ? "none" : list) +
                                           "; or give a " + extension + " file");
  }
  return share_ / "config" / kind / (name_or_file + extension);
}

std::vector<std::string> Catalog::names(const std::string& kind,
                                        const std::string& extension) const {
  std::vector<std::string> found;
  std::error_code error;  // a folder that does not exist holds no names
  for (const auto& entry : std::filesystem::directory_iterator(share_ / "config" / kind, error)) {
    if (entry.path().extension() == extension) {
      found.push_back(entry.path().stem().string());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string placeObject(WorldModel& world, const Catalog& catalog, const std::string& object) {
  if (world.objects.empty()) {
    throw InputError("world " + world.name, "holds no object; add one under `objects`");
  }
  if (object.empty()) {
    return world.objects.front().id;
  }
  for (const ObjectPlacement& placement : world.objects) {
    if (placement.id == object || placement.model == object) {
      return placement.id;
    }
  }
  const std::string wanted = catalog.object(object).name;
  for (const ObjectPlacement& placement : world.objects) {
    if (catalog.object(placement.model).name == wanted) {
      return placement.id;
    }
  }
  ObjectPlacement& first = world.objects.front();
  first.model = object;
  first.id = wanted + "_1";
  first.load.reset();
  return first.id;
}

}  // namespace casepush
