#include "casepush/model/object_model.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "casepush/common/input_error.h"
#include "casters.h"
#include "yaml_pose.h"

namespace casepush {
namespace {

constexpr double kMaxSurfaceFriction = 2.0;
constexpr double kFloorTolerance_m = 0.01;
constexpr int kLargestTagId = 586;  // of the family tag36h11
constexpr double kUpright = 0.999;  // cosine of about 2.5 degrees

std::vector<TagMount> readTags(YamlReader& reader) {
  std::vector<TagMount> tags;
  std::set<int> ids;
  for (YamlReader& entry : reader.children("tags")) {
    TagMount tag;
    tag.id = entry.integer("id", 0, kLargestTagId);
    tag.size_m = entry.number("size_m", 0.01, 1.0);
    tag.object_T_tag = readPose3(entry);
    entry.finish();
    if (!ids.insert(tag.id).second) {
      throw InputError(entry.where("id"), std::to_string(tag.id) + " is taken by another tag");
    }
    tags.push_back(tag);
  }
  if (tags.empty()) {
    throw InputError(reader.where("tags"), "must list at least one tag");
  }
  return tags;
}

/// A locked swivel is a rigid joint: its wheel trails along the direction of zero joint angle.
void lockSwivels(YamlReader& reader, Mechanism* mechanism) {
  for (const std::string& name : reader.texts("locked_swivels")) {
    const auto joint = std::find_if(mechanism->joints.begin(), mechanism->joints.end(),
                                    [&](const Joint& candidate) { return candidate.name == name; });
    const bool found = joint != mechanism->joints.end();
    const int link = static_cast<int>(joint - mechanism->joints.begin()) + 1;
    if (!found || joint->type != JointType::kContinuous ||
        std::abs((mechanism->root_T_link(link).linear() * joint->axis).z()) < kUpright) {
      throw InputError(
          reader.where("locked_swivels"),
          "'" + name + "' is no swivel; must name continuous joints with upright axes");
    }
    joint->type = JointType::kFixed;
  }
}

void checkWheels(const ObjectModel& model, bool is_sliding, const std::string& where) {
  if (model.casters.empty() && !is_sliding) {
    throw InputError(where,
                     "has no casters; an object needs wheels (continuous joints with level "
                     "axes) or `sliding: true` in its YAML");
  }
  if (!model.casters.empty() && is_sliding) {
    throw InputError(where, "has casters, but its YAML says `sliding: true`");
  }
}

void checkHeight(const Solid& solid, const std::string& where) {
  if (solid.empty()) {
    throw InputError(where, "has no collision shapes");
  }
  const double low_m = heightRange(solid).low_m;
  if (std::abs(low_m) > kFloorTolerance_m) {
    std::ostringstream text;
    text << "does not stand on the floor: its lowest point is at z = " << low_m
         << " m, must be within " << kFloorTolerance_m << " m of 0";
    throw InputError(where, text.str());
  }
}

double gyrationRadius(const Mechanism& mechanism) {
  double inertia_kgm2 = 0.0;
  for (int i = 0; i < static_cast<int>(mechanism.links.size()); ++i) {
    const Link& link = mechanism.links[i];
    const Eigen::Isometry3d root_T_inertial = mechanism.root_T_link(i) * link.link_T_inertial;
    const Eigen::Vector3d up = root_T_inertial.linear().transpose() * Eigen::Vector3d::UnitZ();
    inertia_kgm2 += up.dot(link.inertia_kgm2 * up) +
                    link.mass_kg * root_T_inertial.translation().head<2>().squaredNorm();
  }
  return std::sqrt(inertia_kgm2 / mechanism.massKg());
}

}  // namespace

ObjectModel loadObjectModel(const std::filesystem::path& urdf_file) {
  ObjectModel model;
  model.name = urdf_file.stem().string();
  model.mechanism = loadMechanism(urdf_file);
  YamlReader reader =
      YamlReader::fromFile(std::filesystem::path(urdf_file).replace_extension("yaml"));
  lockSwivels(reader, &model.mechanism);
  model.casters = findCasters(model.mechanism, urdf_file.string());

  model.class_name = reader.text("class");
  model.tags = readTags(reader);
  model.surface_friction =
      reader.number("surface_friction", 0.0, kMaxSurfaceFriction, model.surface_friction);
  checkWheels(model, reader.flag("sliding", false), urdf_file.string());
  reader.finish();

  model.solid = sweptSolid(model.mechanism, model.casters);
  checkHeight(model.solid, urdf_file.string());
  model.radius_m = circumscribedRadius(model.solid);
  model.gyration_radius_m = gyrationRadius(model.mechanism);
  return model;
}

}  // namespace casepush
