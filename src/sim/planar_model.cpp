#include "planar_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <variant>

#include "casepush/common/input_error.h"
#include "wheel_loads.h"

namespace casepush::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFloorContact_m = 0.001;  // Points this much above the lowest one still touch.
constexpr int kRimPoints = 8;

struct Lump {
  double mass_kg = 0.0;
  Vector2d root_p_com = Vector2d::Zero();
  double inertia_kgm2 = 0.0;  // About its own centre of mass, upright axis.
};

Lump lumpOf(const FurnitureBlueprint& blueprint, const std::vector<int>& bodies) {
  Lump lump;
  for (const int b : bodies) {
    const MassProperties& mass = blueprint.bodies[static_cast<std::size_t>(b)].mass;
    lump.mass_kg += mass.mass_kg;
    lump.root_p_com += mass.mass_kg * mass.root_T_com.translation().head<2>();
  }
  lump.root_p_com /= lump.mass_kg;
  for (const int b : bodies) {
    const MassProperties& mass = blueprint.bodies[static_cast<std::size_t>(b)].mass;
    const Vector2d arm = mass.root_T_com.translation().head<2>() - lump.root_p_com;
    lump.inertia_kgm2 += mass.rootInertia()(2, 2) + mass.mass_kg * arm.squaredNorm();
  }
  return lump;
}

PlanarWheel makeWheel(const FurnitureBlueprint& blueprint, int body_index, int swivel,
                      const Vector2d& root_p_reference) {
  const BodyBlueprint& body = blueprint.bodies[static_cast<std::size_t>(body_index)];
  PlanarWheel wheel;
  wheel.joint = body_index - 1;
  wheel.swivel = swivel;
  wheel.contact_m = body.root_pivot_m.head<2>() - root_p_reference;
  wheel.rolling = body.root_axis.cross(Vector3d::UnitZ()).head<2>().normalized();
  wheel.radius_m = blueprint.wheel_radius_m[static_cast<std::size_t>(body.wheel)];
  const double inertia = body.root_axis.dot(body.mass.rootInertia() * body.root_axis);
  wheel.spin_mass_kg = inertia / (wheel.radius_m * wheel.radius_m);
  wheel.friction_nm = body.friction_nm;
  return wheel;
}

// Corners of a shape that may touch the floor, in the root frame.
std::vector<Vector3d> cornersOf(const Shape& shape, const Eigen::Isometry3d& root_T_shape) {
  std::vector<Vector3d> corners;
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (int i = 0; i < 8; ++i) {
      const Vector3d sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
      corners.push_back(root_T_shape * sign.cwiseProduct(box->size_m));
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    for (int i = 0; i < 2 * kRimPoints; ++i) {
      const double angle = 2.0 * M_PI * (i / 2) / kRimPoints;
      corners.push_back(root_T_shape * Vector3d(cylinder->radius_m * std::cos(angle),
                                                cylinder->radius_m * std::sin(angle),
                                                (i % 2 - 0.5) * cylinder->length_m));
    }
  } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    corners.push_back(root_T_shape.translation() - Vector3d(0.0, 0.0, sphere->radius_m));
  }
  return corners;
}

std::vector<Vector2d> findSkids(const FurnitureBlueprint& blueprint, const Vector2d& root_p_com) {
  const Mechanism& mechanism = blueprint.model->mechanism;
  std::vector<Vector3d> corners;
  for (std::size_t i = 0; i < mechanism.links.size(); ++i) {
    if (blueprint.body_of_link[i] != 0) continue;
    for (const PlacedShape& placed : mechanism.links[i].collision) {
      const auto more = cornersOf(
          placed.shape, mechanism.root_T_link(static_cast<int>(i)) * placed.frame_T_shape);
      corners.insert(corners.end(), more.begin(), more.end());
    }
  }
  double lowest_m = INFINITY;
  for (const Vector3d& corner : corners) lowest_m = std::min(lowest_m, corner.z());
  std::vector<Vector2d> skids;
  for (const Vector3d& corner : corners) {
    if (corner.z() < lowest_m + kFloorContact_m) skids.push_back(corner.head<2>() - root_p_com);
  }
  return skids;
}

void addCasters(const FurnitureBlueprint& blueprint, PlanarModel& result) {
  result.wheels.resize(blueprint.wheel_radius_m.size());
  for (std::size_t b = 1; b < blueprint.bodies.size(); ++b) {
    const BodyBlueprint& body = blueprint.bodies[b];
    const int index = static_cast<int>(b);
    if (body.wheel >= 0 && body.parent == 0) {
      result.wheels[static_cast<std::size_t>(body.wheel)] =
          makeWheel(blueprint, index, -1, result.root_p_com);
    }
    if (!body.swivels) continue;
    const Vector2d pivot = body.root_pivot_m.head<2>();
    std::vector<int> bodies{index};
    for (std::size_t w = b + 1; w < blueprint.bodies.size(); ++w) {
      if (blueprint.bodies[w].parent != index) continue;
      PlanarWheel wheel =
          makeWheel(blueprint, static_cast<int>(w), static_cast<int>(result.swivels.size()), pivot);
      wheel.holds_bearing = bodies.size() == 1;
      bodies.push_back(static_cast<int>(w));
      result.wheels[static_cast<std::size_t>(blueprint.bodies[w].wheel)] = wheel;
    }
    const Lump lump = lumpOf(blueprint, bodies);
    result.swivels.push_back({index - 1, body.root_axis.z() > 0.0 ? 1.0 : -1.0,
                              pivot - result.root_p_com, lump.mass_kg, lump.root_p_com - pivot,
                              lump.inertia_kgm2, body.friction_nm});
  }
}

// With casters in their middle positions: a load on the edge of what it stands on may still lift a
// wheel, but what cannot stand at all has no planar motion.
void checkStanding(const FurnitureBlueprint& blueprint, const PlanarModel& model) {
  std::vector<Vector2d> points = model.skids;
  Vector2d moment = Vector2d::Zero();
  for (const PlanarWheel& wheel : model.wheels) {
    const bool swivels = wheel.swivel >= 0;
    points.push_back(swivels ? model.swivels[static_cast<std::size_t>(wheel.swivel)].chassis_p_pivot
                             : wheel.contact_m);
  }
  for (const PlanarSwivel& swivel : model.swivels) {
    moment += swivel.mass_kg * swivel.chassis_p_pivot;
  }
  std::vector<double> shares(points.size());
  const bool stands =
      shareLoad(points, model.mass_kg, moment, shares) &&
      std::count_if(shares.begin(), shares.end(), [](double n) { return n > 0.0; }) >= 3;
  if (!stands) {
    std::ostringstream text;
    text << "the planar caster model needs three or more wheels or feet that bear load";
    if (blueprint.load) {
      text << "; with " << blueprint.load->mass_kg << " kg at ("
           << blueprint.load->object_p_centre_m.x() << ", " << blueprint.load->object_p_centre_m.y()
           << ") m it would tip over";
    }
    throw InputError(blueprint.model->name, text.str());
  }
}

}  // namespace

PlanarModel makePlanarModel(const FurnitureBlueprint& blueprint) {
  PlanarModel result;
  std::vector<int> chassis{0};
  double height_moment = 0.0;
  for (std::size_t b = 0; b < blueprint.bodies.size(); ++b) {
    const BodyBlueprint& body = blueprint.bodies[b];
    if (b > 0 && body.wheel >= 0 && body.parent == 0) chassis.push_back(static_cast<int>(b));
    result.mass_kg += body.mass.mass_kg;
    height_moment += body.mass.mass_kg * body.mass.root_T_com.translation().z();
  }
  result.com_height_m = height_moment / result.mass_kg;
  const Lump lump = lumpOf(blueprint, chassis);
  result.root_p_com = lump.root_p_com;
  result.chassis_mass_kg = lump.mass_kg;
  result.chassis_inertia_kgm2 = lump.inertia_kgm2;
  addCasters(blueprint, result);
  if (result.wheels.empty()) result.skids = findSkids(blueprint, result.root_p_com);
  checkStanding(blueprint, result);
  return result;
}

}  // namespace casepush::sim
