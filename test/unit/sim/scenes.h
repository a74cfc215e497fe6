#pragma once

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"
#include "casepush/model/world_model.h"

namespace casepush::test {

inline Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

inline Eigen::Matrix3d boxInertia(double mass_kg, const Eigen::Vector3d& size_m) {
  const Eigen::Vector3d s = size_m.cwiseAbs2();
  return mass_kg / 12.0 *
         Eigen::Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal().toDenseMatrix();
}

inline Link makeLink(const std::string& name, double mass_kg, const Eigen::Matrix3d& inertia) {
  Link link;
  link.name = name;
  link.mass_kg = mass_kg;
  link.inertia_kgm2 = inertia;
  return link;
}

struct CartOptions {
  double mass_kg = 30.0;
  double wheel_radius_m = 0.05;
  double trail_m = 0.035;
  double swivel_friction_nm = 0.1;
  bool swivels = true;  ///< False: fixed wheels that roll along x.
};

constexpr double kForkMass_kg = 0.4;
constexpr double kWheelMass_kg = 0.6;

inline double wheelInertia(double radius_m) { return 0.5 * kWheelMass_kg * radius_m * radius_m; }

inline void addJoint(Mechanism& mechanism, const std::string& name, int parent, JointType type,
                     const Eigen::Vector3d& origin, const Eigen::Vector3d& axis, double friction_nm,
                     Link child) {
  Joint joint;
  joint.name = name;
  joint.type = type;
  joint.parent_link = parent;
  joint.parent_T_joint.translation() = origin;
  joint.axis = axis;
  joint.friction_nm = friction_nm;
  mechanism.joints.push_back(std::move(joint));
  mechanism.links.push_back(std::move(child));
}

inline void addCaster(ObjectModel& model, const CartOptions& options, const std::string& name,
                      double x, double y) {
  Mechanism& mechanism = model.mechanism;
  const double r = options.wheel_radius_m;
  const int fork = static_cast<int>(mechanism.links.size());
  addJoint(mechanism, name + "_swivel", 0,
           options.swivels ? JointType::kContinuous : JointType::kFixed, {x, y, 0.12},
           Eigen::Vector3d::UnitZ(), options.swivel_friction_nm,
           makeLink(name + "_fork", kForkMass_kg,
                    boxInertia(kForkMass_kg, Eigen::Vector3d(0.04, 0.04, 0.06))));
  Link wheel = makeLink(name + "_wheel", kWheelMass_kg, Eigen::Matrix3d::Identity());
  wheel.inertia_kgm2.diagonal() << 0.6 * wheelInertia(r), wheelInertia(r), 0.6 * wheelInertia(r);
  addJoint(mechanism, name + "_axle", fork, JointType::kContinuous,
           {-options.trail_m, 0.0, r - 0.12}, Eigen::Vector3d::UnitY(), 0.0, std::move(wheel));
  Caster caster;
  caster.swivel_joint = options.swivels ? fork - 1 : -1;
  caster.wheel_joint = fork;
  caster.wheel_radius_m = r;
  caster.trail_m = options.trail_m;
  model.casters.push_back(caster);
}

/// A tag at the front face (towards +x) of something whose face is at `x`.
inline TagMount frontTag(int id, double size_m, double x, double z) {
  TagMount tag;
  tag.id = id;
  tag.size_m = size_m;
  // Seen from the front, its x is the object's +y, its y points down and its z into the object.
  tag.object_T_tag.linear().col(0) = Eigen::Vector3d::UnitY();
  tag.object_T_tag.linear().col(1) = -Eigen::Vector3d::UnitZ();
  tag.object_T_tag.linear().col(2) = -Eigen::Vector3d::UnitX();
  tag.object_T_tag.translation() << x, 0.0, z;
  return tag;
}

/// A box of 0.6 m x 0.4 m on four casters, 0.12 m above the floor.
inline ObjectModel makeCart(const CartOptions& options = {}) {
  ObjectModel model;
  model.name = "cart";
  model.class_name = "cart";
  const Eigen::Vector3d size(0.6, 0.4, 0.5);
  Link body = makeLink("body", options.mass_kg, boxInertia(options.mass_kg, size));
  body.link_T_inertial = at(0.0, 0.0, 0.37);
  body.collision.push_back({Box{size}, at(0.0, 0.0, 0.37), "body"});
  model.mechanism.name = model.name;
  model.mechanism.links.push_back(std::move(body));
  addCaster(model, options, "front_left", 0.22, 0.15);
  addCaster(model, options, "front_right", 0.22, -0.15);
  addCaster(model, options, "rear_left", -0.22, 0.15);
  addCaster(model, options, "rear_right", -0.22, -0.15);
  model.tags.push_back(frontTag(1, 0.16, 0.3, 0.4));
  model.radius_m = 0.5;
  model.gyration_radius_m = 0.2;
  return model;
}

/// A box that slides on the floor.
inline ObjectModel makeCrate() {
  ObjectModel model;
  model.name = "crate";
  model.class_name = "crate";
  const Eigen::Vector3d size(0.5, 0.5, 0.3);
  Link body = makeLink("body", 10.0, boxInertia(10.0, size));
  body.link_T_inertial = at(0.0, 0.0, 0.15);
  body.collision.push_back({Box{size}, at(0.0, 0.0, 0.15), "body"});
  model.mechanism.name = model.name;
  model.mechanism.links.push_back(std::move(body));
  return model;
}

/// 40 kg; a square bumper of 0.5 m below a thin mast, so that it pushes a flat face squarely.
inline RobotModel makeRobot() {
  RobotModel robot;
  robot.name = "pusher";
  const Eigen::Vector3d size(0.5, 0.5, 0.4);
  Link base = makeLink("base", 40.0, boxInertia(40.0, size));
  base.link_T_inertial = at(0.0, 0.0, 0.3);
  base.collision.push_back({Box{size}, at(0.0, 0.0, 0.3), "base"});
  robot.mechanism.name = robot.name;
  robot.mechanism.links.push_back(base);
  robot.solid.push_back(base.collision[0]);
  robot.solid.push_back({Cylinder{0.05, 1.0}, at(0.0, 0.0, 1.0), "mast"});
  robot.radius_m = 0.36;
  return robot;
}

/// Looks along the robot's +x from 0.3 m in front of its origin.
inline CameraModel makeCamera() {
  CameraModel camera;
  camera.name = "front";
  camera.base_T_camera.linear().col(0) = -Eigen::Vector3d::UnitY();
  camera.base_T_camera.linear().col(1) = -Eigen::Vector3d::UnitZ();
  camera.base_T_camera.linear().col(2) = Eigen::Vector3d::UnitX();
  camera.base_T_camera.translation() << 0.3, 0.0, 0.5;
  camera.width_px = 1280;
  camera.height_px = 960;
  camera.horizontal_fov_rad = 1.6;
  camera.rate_hz = 20.0;
  camera.dropout = 0.0;
  return camera;
}

/// Sees all around from the mast, with noise and missing returns.
inline RangeSensorModel makeScanner() {
  RangeSensorModel scanner;
  scanner.name = "scanner";
  scanner.base_T_sensor = at(0.0, 0.0, 0.55);
  scanner.beams = 60;
  scanner.dropout = 0.05;
  return scanner;
}

inline StaticBox makeBox(const std::string& name, const Eigen::Vector3d& size, double x, double y) {
  return {name, Box{size}, at(x, y, 0.5 * size.z())};
}

/// An empty 20 m x 20 m floor with the robot 2 m behind the origin, facing +x.
inline WorldModel makeWorld() {
  WorldModel world;
  world.name = "test_floor";
  world.min_m << -10.0, -10.0;
  world.max_m << 10.0, 10.0;
  world.robot = "pusher";
  world.map_T_robot = Pose2(-2.0, 0.0, 0.0);
  return world;
}

inline WorldModel makeCartWorld(const Pose2& map_T_cart = {}) {
  WorldModel world = makeWorld();
  world.objects.push_back({"cart_1", "cart", map_T_cart, 0});
  return world;
}

}  // namespace casepush::test
