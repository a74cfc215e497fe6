#include "casters.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr double kFloorTolerance_m = 0.01;
constexpr double kParallel = 0.999;  // cosine of about 2.5 degrees

enum class AxisKind { kUpright, kLevel, kOblique };

Eigen::Vector3d rootAxis(const Mechanism& mechanism, int joint) {
  return mechanism.root_T_link(joint + 1).linear() * mechanism.joints[joint].axis;
}

AxisKind axisKind(const Mechanism& mechanism, int joint) {
  const double z = std::abs(rootAxis(mechanism, joint).z());
  if (z > kParallel) {
    return AxisKind::kUpright;
  }
  return z < std::sqrt(1.0 - kParallel * kParallel) ? AxisKind::kLevel : AxisKind::kOblique;
}

/// The next continuous joint from a link towards the root; -1 if there is none.
int movingJointAbove(const Mechanism& mechanism, int link) {
  while (link > 0) {
    const Joint& joint = mechanism.joints[link - 1];
    if (joint.type == JointType::kContinuous) {
      return link - 1;
    }
    link = joint.parent_link;
  }
  return -1;
}

double wheelRadius(const Mechanism& mechanism, int joint, const std::string& where) {
  const Link& wheel = mechanism.links[joint + 1];
  double radius_m = -1.0;
  if (wheel.collision.size() == 1) {
    const PlacedShape& shape = wheel.collision.front();
    const Eigen::Vector3d axis = mechanism.joints[joint].axis;
    const Eigen::Vector3d offset = shape.frame_T_shape.translation();
    const bool is_centred = (offset - axis * axis.dot(offset)).norm() < 1e-4;
    const bool is_around = std::abs(shape.frame_T_shape.linear().col(2).dot(axis)) > kParallel;
    if (const auto* sphere = std::get_if<Sphere>(&shape.shape); sphere && is_centred) {
      radius_m = sphere->radius_m;
    } else if (const auto* cylinder = std::get_if<Cylinder>(&shape.shape);
               cylinder && is_centred && is_around) {
      radius_m = cylinder->radius_m;
    }
  }
  if (radius_m < 0.0) {
    throw InputError(where, "carries no wheel: link '" + wheel.name +
                                "' must have one collision shape, a cylinder or sphere around the "
                                "joint's axis");
  }
  const double bottom_m = mechanism.root_T_link(joint + 1).translation().z() - radius_m;
  if (std::abs(bottom_m) > kFloorTolerance_m) {
    std::ostringstream text;
    text << "has a wheel that does not touch the floor: its lowest point is at z = " << bottom_m
         << " m, must be within " << kFloorTolerance_m << " m of 0";
    throw InputError(where, text.str());
  }
  return radius_m;
}

Caster makeCaster(const Mechanism& mechanism, int wheel_joint, const std::string& where) {
  Caster caster;
  caster.wheel_joint = wheel_joint;
  caster.wheel_radius_m = wheelRadius(mechanism, wheel_joint, where);
  caster.swivel_joint = movingJointAbove(mechanism, mechanism.joints[wheel_joint].parent_link);
  if (caster.swivel_joint < 0) {
    return caster;
  }
  if (axisKind(mechanism, caster.swivel_joint) != AxisKind::kUpright ||
      movingJointAbove(mechanism, mechanism.joints[caster.swivel_joint].parent_link) >= 0) {
    throw InputError(where,
                     "hangs on more than one moving joint; must hang on none or on one swivel");
  }
  const Eigen::Vector3d offset = mechanism.root_T_link(wheel_joint + 1).translation() -
                                 mechanism.root_T_link(caster.swivel_joint + 1).translation();
  const Eigen::Vector3d axle = rootAxis(mechanism, wheel_joint);
  caster.trail_m = std::abs(offset.x() * axle.y() - offset.y() * axle.x());
  return caster;
}

Solid rootShapes(const Mechanism& mechanism, int link) {
  Solid shapes = mechanism.links[link].collision;
  for (PlacedShape& shape : shapes) {
    shape.frame_T_shape = mechanism.root_T_link(link) * shape.frame_T_shape;
  }
  return shapes;
}

/// Upright cylinder around the swivel's axis that holds the shapes at every swivel angle.
PlacedShape sweep(const Mechanism& mechanism, int swivel_joint, Solid shapes) {
  Eigen::Vector3d pivot = mechanism.root_T_link(swivel_joint + 1).translation();
  const HeightRange height = heightRange(shapes);
  pivot.z() = 0.0;
  for (PlacedShape& shape : shapes) {
    shape.frame_T_shape.pretranslate(-pivot);
  }
  PlacedShape swept;
  swept.shape = Cylinder{circumscribedRadius(shapes), height.high_m - height.low_m};
  pivot.z() = 0.5 * (height.low_m + height.high_m);
  swept.frame_T_shape.translation() = pivot;
  swept.part = mechanism.links[swivel_joint + 1].name;
  return swept;
}

}  // namespace

std::vector<Caster> findCasters(const Mechanism& mechanism, const std::string& where) {
  std::vector<Caster> casters;
  std::set<int> swivels;
  std::set<int> used_swivels;
  for (int joint = 0; joint < static_cast<int>(mechanism.joints.size()); ++joint) {
    if (mechanism.joints[joint].type != JointType::kContinuous) {
      continue;
    }
    const std::string joint_where = where + ": joint '" + mechanism.joints[joint].name + "'";
    const AxisKind kind = axisKind(mechanism, joint);
    if (kind == AxisKind::kUpright) {
      swivels.insert(joint);
    } else if (kind == AxisKind::kLevel) {
      casters.push_back(makeCaster(mechanism, joint, joint_where));
      used_swivels.insert(casters.back().swivel_joint);
    } else {
      throw InputError(joint_where, "is neither a swivel (upright axis) nor a wheel (level axis)");
    }
  }
  for (const int swivel : swivels) {
    if (used_swivels.count(swivel) == 0) {
      throw InputError(where + ": joint '" + mechanism.joints[swivel].name + "'",
                       "is a swivel without a wheel");
    }
  }
  return casters;
}

Solid sweptSolid(const Mechanism& mechanism, const std::vector<Caster>& casters) {
  std::set<int> swivels;
  for (const Caster& caster : casters) {
    swivels.insert(caster.swivel_joint);
  }
  swivels.erase(-1);

  Solid solid;
  std::vector<Solid> swivelled(mechanism.joints.size());
  for (int link = 0; link < static_cast<int>(mechanism.links.size()); ++link) {
    int joint = movingJointAbove(mechanism, link);
    while (joint >= 0 && swivels.count(joint) == 0) {  // a wheel's own joint
      joint = movingJointAbove(mechanism, mechanism.joints[joint].parent_link);
    }
    Solid& target = joint >= 0 ? swivelled[joint] : solid;
    for (PlacedShape& shape : rootShapes(mechanism, link)) {
      target.push_back(std::move(shape));
    }
  }
  for (const int swivel : swivels) {
    solid.push_back(sweep(mechanism, swivel, swivelled[swivel]));
  }
  return solid;
}

}  // namespace casepush
