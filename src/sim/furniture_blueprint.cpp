#include "furniture_blueprint.h"

#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include "bullet_conversions.h"
#include "casepush/common/input_error.h"

namespace casepush::sim {
namespace {

// Groups links by the continuous joints between them; fills body_of_link and the tree of bodies.
std::vector<std::vector<int>> groupLinks(const Mechanism& mechanism, FurnitureBlueprint& result) {
  std::vector<std::vector<int>> links_of_body{{0}};
  result.bodies.resize(1);
  result.body_of_link.assign(mechanism.links.size(), 0);
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    const int link = static_cast<int>(j) + 1;
    int body = result.body_of_link[static_cast<std::size_t>(joint.parent_link)];
    if (joint.type == JointType::kContinuous) {
      BodyBlueprint blueprint;
      blueprint.parent = body;
      blueprint.joint = static_cast<int>(j);
      blueprint.friction_nm = joint.friction_nm;
      const Eigen::Isometry3d root_T_joint = mechanism.root_T_link(link);
      blueprint.root_pivot_m = root_T_joint.translation();
      blueprint.root_axis = root_T_joint.linear() * joint.axis;
      body = static_cast<int>(result.bodies.size());
      result.bodies.push_back(std::move(blueprint));
      links_of_body.emplace_back();
    }
    result.body_of_link[static_cast<std::size_t>(link)] = body;
    links_of_body[static_cast<std::size_t>(body)].push_back(link);
  }
  return links_of_body;
}

void markCasters(const std::vector<Caster>& casters, FurnitureBlueprint& result) {
  for (std::size_t i = 0; i < casters.size(); ++i) {
    result.wheel_radius_m.push_back(casters[i].wheel_radius_m);
    for (BodyBlueprint& body : result.bodies) {
      if (body.joint < 0) continue;
      if (body.joint == casters[i].wheel_joint) body.wheel = static_cast<int>(i);
      if (body.joint == casters[i].swivel_joint) body.swivels = true;
    }
  }
}

// Of a wheel's shape: a floor contact nearer than this to the one of the step before replaces it.
// Bullet's own bound for spheres, 0.02 r, is less than a wheel rolls in a step: points that it has
// left behind would stay, and what they bear behind the axle would drive it forwards.
template <typename Shape>
struct Rolling final : Shape {
  using Shape::Shape;
  btScalar getContactBreakingThreshold(btScalar) const override {
    return 0.5 * this->getAngularMotionDisc();
  }
};

// A sphere touches a plane in one well-conditioned point and rolls true; a wheel's width matters
// only on uneven floors. Under load it has the wheel's radius.
void addWheelShape(BodyBlueprint& body, FurnitureBlueprint& result) {
  const double radius_m =
      result.wheel_radius_m[static_cast<std::size_t>(body.wheel)] + kWheelSink_m;
  auto sphere = std::make_unique<Rolling<btSphereShape>>(radius_m);
  const Eigen::Vector3d com_p_pivot = body.mass.root_T_com.inverse() * body.root_pivot_m;
  if (com_p_pivot.norm() < 1e-9) {
    body.shape = sphere.get();
  } else {
    auto offset = std::make_unique<Rolling<btCompoundShape>>(false);
    offset->addChildShape(btTransform(btMatrix3x3::getIdentity(), toBullet(com_p_pivot)),
                          sphere.get());
    body.shape = offset.get();
    result.wheel_shapes.push_back(std::move(offset));
  }
  result.wheel_shapes.push_back(std::move(sphere));
}

void addBodyShape(const Mechanism& mechanism, const std::vector<int>& links, BodyBlueprint& body,
                  FurnitureBlueprint& result) {
  auto compound = std::make_unique<CompoundShape>();
  const Eigen::Isometry3d com_T_root = body.mass.root_T_com.inverse();
  for (const int i : links) {
    const Link& link = mechanism.links[static_cast<std::size_t>(i)];
    for (PlacedShape shape : link.collision) {
      shape.part = link.name;
      compound->add(shape, com_T_root * mechanism.root_T_link(i));
    }
  }
  if (compound->isEmpty()) return;
  body.shape = compound->get();
  body.tag.parts = compound->parts();
  result.compounds.push_back(std::move(compound));
}

}  // namespace

FurnitureBlueprint makeBlueprint(const std::string& id, int index, const ObjectModel& model,
                                 std::optional<Load> load) {
  const Mechanism& mechanism = model.mechanism;
  FurnitureBlueprint result;
  result.id = id;
  result.model = &model;
  if (load && load->mass_kg > 0.0) result.load = load;
  result.mass_kg = mechanism.massKg() + (result.load ? result.load->mass_kg : 0.0);
  const std::vector<std::vector<int>> links_of_body = groupLinks(mechanism, result);
  markCasters(model.casters, result);
  bool touches_floor = false;
  for (std::size_t b = 0; b < result.bodies.size(); ++b) {
    BodyBlueprint& body = result.bodies[b];
    body.mass =
        composeMass(mechanism, links_of_body[b], b == 0 ? result.load : std::optional<Load>());
    body.tag.kind = body.wheel >= 0 ? CollisionTag::Kind::kWheel : CollisionTag::Kind::kFurniture;
    body.tag.body = id;
    body.tag.object = index;
    body.tag.wheel = body.wheel;
    if (body.wheel >= 0) {
      body.tag.parts = {mechanism.links[static_cast<std::size_t>(body.joint) + 1].name};
      addWheelShape(body, result);
    } else {
      addBodyShape(mechanism, links_of_body[b], body, result);
    }
    touches_floor = touches_floor || body.wheel >= 0 || (b == 0 && body.shape != nullptr);
  }
  if (!touches_floor) {
    throw InputError(model.name, "has neither wheels nor collision shapes on its root");
  }
  for (std::size_t i = 0; i < mechanism.links.size(); ++i) {
    const BodyBlueprint& body = result.bodies[static_cast<std::size_t>(result.body_of_link[i])];
    result.com_T_link.push_back(body.mass.root_T_com.inverse() *
                                mechanism.root_T_link(static_cast<int>(i)));
  }
  return result;
}

}  // namespace casepush::sim
