#include <urdf_model/model.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>

#include "casepush/common/input_error.h"
#include "casepush/model/mechanism.h"
#include "urdf_parse.h"

namespace casepush {
namespace {

// Far beyond any furniture, so that footprints, collision checks and physics stay feasible.
constexpr double kLargestLength_m = 10.0;
constexpr double kLargestMass_kg = 1e4;
constexpr double kLargestInertia_kgm2 = 1e6;
constexpr double kLargestFriction_nm = 1e4;

Eigen::Isometry3d toIsometry(const urdf::Pose& pose) {
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.translation() << pose.position.x, pose.position.y, pose.position.z;
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  isometry.linear() = rotation.normalized().toRotationMatrix();
  return isometry;
}

/// Turns the parsed tree into a Mechanism and checks it on the way.
class MechanismBuilder {
 public:
  MechanismBuilder(const std::filesystem::path& file, const urdf::ModelInterface& model)
      : file_(file.string()) {
    mechanism_.name = model.getName();
    addLink(*model.getRoot());
    addChildren(*model.getRoot(), 0);
    checkReach();
  }

  Mechanism take() { return std::move(mechanism_); }

 private:
  void addChildren(const urdf::Link& link, int index) {
    for (const urdf::JointSharedPtr& child : link.child_joints) {
      addJoint(*child, index);
      const auto next = static_cast<int>(mechanism_.links.size());
      for (const urdf::LinkSharedPtr& child_link : link.child_links) {
        if (child_link->name == child->child_link_name) {
          addLink(*child_link);
          addChildren(*child_link, next);
        }
      }
    }
  }

  void addLink(const urdf::Link& parsed) {
    Link link;
    link.name = parsed.name;
    const std::string where = file_ + ": link '" + link.name + "'";
    setInertia(parsed, where, &link);
    for (const urdf::CollisionSharedPtr& collision : parsed.collision_array) {
      PlacedShape shape{toShape(*collision->geometry, where), toIsometry(collision->origin),
                        link.name};
      requireNear(shape.frame_T_shape, where + ": collision origin");
      link.collision.push_back(std::move(shape));
    }
    if (parsed.visual && parsed.visual->material) {
      const urdf::Color& colour = parsed.visual->material->color;
      link.colour_rgba << colour.r, colour.g, colour.b, colour.a;
    }
    mechanism_.links.push_back(std::move(link));
  }

  void addJoint(const urdf::Joint& parsed, int parent) {
    Joint joint;
    joint.name = parsed.name;
    const std::string where = file_ + ": joint '" + joint.name + "'";
    if (parsed.type == urdf::Joint::CONTINUOUS) {
      joint.type = JointType::kContinuous;
    } else if (parsed.type != urdf::Joint::FIXED) {
      throw InputError(where, "has an unsupported type; must be fixed or continuous");
    }
    joint.parent_link = parent;
    joint.parent_T_joint = toIsometry(parsed.parent_to_joint_origin_transform);
    requireNear(joint.parent_T_joint, where + ": origin");
    joint.axis << parsed.axis.x, parsed.axis.y, parsed.axis.z;
    if (joint.type == JointType::kContinuous) {
      if (!(joint.axis.stableNorm() > 1e-6) || !joint.axis.allFinite()) {
        throw InputError(where, "has no axis; must be a finite vector other than zero");
      }
      joint.axis.stableNormalize();
      joint.friction_nm = parsed.dynamics ? parsed.dynamics->friction : 0.0;
      checkDynamics(parsed, where);
    }
    mechanism_.joints.push_back(std::move(joint));
  }

  static void checkDynamics(const urdf::Joint& joint, const std::string& where) {
    if (!joint.dynamics) {
      return;
    }
    if (!(joint.dynamics->friction >= 0.0 && joint.dynamics->friction <= kLargestFriction_nm)) {
      std::ostringstream text;
      text << "is " << joint.dynamics->friction << "; must be in [0, " << kLargestFriction_nm
           << "] Nm";
      throw InputError(where + ": dynamics friction", text.str());
    }
    if (joint.dynamics->damping != 0.0) {
      throw InputError(where + ": dynamics damping", "is not supported; must be 0, use friction");
    }
  }

  static void setInertia(const urdf::Link& parsed, const std::string& where, Link* link) {
    if (!parsed.inertial) {
      throw InputError(where, "has no inertia; every link needs an <inertial> element");
    }
    const urdf::Inertial& inertial = *parsed.inertial;
    link->mass_kg = inertial.mass;
    if (!(link->mass_kg > 0.0 && link->mass_kg <= kLargestMass_kg)) {
      std::ostringstream text;
      text << "has a mass of " << link->mass_kg << " kg; must be above 0 and at most "
           << kLargestMass_kg << " kg";
      throw InputError(where, text.str());
    }
    link->link_T_inertial = toIsometry(inertial.origin);
    requireNear(link->link_T_inertial, where + ": inertial origin");
    link->inertia_kgm2 << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy,
        inertial.iyz, inertial.ixz, inertial.iyz, inertial.izz;
    checkInertia(link->inertia_kgm2, where);
  }

  static void checkInertia(const Eigen::Matrix3d& inertia_kgm2, const std::string& where) {
    if (!inertia_kgm2.allFinite() || inertia_kgm2.cwiseAbs().maxCoeff() > kLargestInertia_kgm2) {
      std::ostringstream text;
      text << "must be finite and at most " << kLargestInertia_kgm2 << " kg m^2";
      throw InputError(where + ": inertia", text.str());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia_kgm2,
                                                                Eigen::EigenvaluesOnly);
    const Eigen::Vector3d moments = solver.eigenvalues();  // ascending
    std::ostringstream values;
    values << "(principal moments " << moments(0) << ", " << moments(1) << ", " << moments(2)
           << " kg m^2)";
    if (!(moments(0) > 0.0)) {
      throw InputError(where, "has an inertia that is not positive definite " + values.str());
    }
    if (moments(0) + moments(1) < moments(2) * (1.0 - 1e-6)) {
      throw InputError(where,
                       "has an inertia that no body can have: the largest principal moment "
                       "exceeds the sum of the others " +
                           values.str());
    }
  }

  static Shape toShape(const urdf::Geometry& geometry, const std::string& where) {
    Shape shape;
    Eigen::Vector3d extents = Eigen::Vector3d::Ones();
    if (geometry.type == urdf::Geometry::BOX) {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      extents << size.x, size.y, size.z;
      shape = Box{extents};
    } else if (geometry.type == urdf::Geometry::CYLINDER) {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      extents << cylinder.radius, cylinder.length, 1.0;
      shape = Cylinder{cylinder.radius, cylinder.length};
    } else if (geometry.type == urdf::Geometry::SPHERE) {
      const double radius_m = static_cast<const urdf::Sphere&>(geometry).radius;
      extents.x() = radius_m;
      shape = Sphere{radius_m};
    } else {
      throw InputError(where, "has a mesh for collision; must be boxes, cylinders or spheres");
    }
    if (!extents.allFinite() || extents.minCoeff() <= 0.0 ||
        extents.maxCoeff() > kLargestLength_m) {
      std::ostringstream text;
      text << "has a size that is not above 0 and at most " << kLargestLength_m << " m";
      throw InputError(where + ": collision", text.str());
    }
    return shape;
  }

  static void requireNear(const Eigen::Isometry3d& pose, const std::string& where) {
    if (!pose.matrix().allFinite()) {
      throw InputError(where, "is not finite");
    }
    if (pose.translation().cwiseAbs().maxCoeff() > kLargestLength_m) {
      std::ostringstream text;
      text << "is (" << pose.translation().transpose() << "); each must be within "
           << kLargestLength_m << " m of 0";
      throw InputError(where, text.str());
    }
  }

  /// Many short joints may reach far, too.
  void checkReach() const {
    for (int i = 0; i < static_cast<int>(mechanism_.links.size()); ++i) {
      requireNear(mechanism_.root_T_link(i),
                  file_ + ": link '" + mechanism_.links[i].name + "': place in the root link");
    }
  }

  std::string file_;
  Mechanism mechanism_;
};

}  // namespace

Mechanism loadMechanism(const std::filesystem::path& urdf_file) {
  const urdf::ModelInterfaceSharedPtr model = parseUrdf(urdf_file);
  return MechanismBuilder(urdf_file, *model).take();
}

}  // namespace casepush
