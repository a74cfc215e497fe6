#pragma once

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>

#include "casepush/common/pose2.h"
#include "casepush/model/robot_model.h"
#include "collision.h"
#include "mass_properties.h"
#include "planar_servo.h"

namespace casepush::sim {

/// All of the robot that stays the same whenever the world is rebuilt.
struct RobotBlueprint {
  RobotLimits limits;
  double surface_friction = 0.0;
  MassProperties mass;
  Eigen::Isometry3d base_T_com = Eigen::Isometry3d::Identity();  ///< Axes of the base frame.
  CompoundShape shape;
  CollisionTag tag;
};

/// @throws InputError if nothing of the robot collides.
RobotBlueprint makeBlueprint(const RobotModel& robot);

struct RobotState {
  btTransform map_T_com = btTransform::getIdentity();
  btVector3 velocity_mps{0, 0, 0};
  btVector3 omega_rps{0, 0, 0};
};

RobotState stateAtRest(const RobotBlueprint& blueprint, const Pose2& map_T_robot);

/// An omnidirectional base that moves in the plane of the floor, whatever moves it.
class Robot {
 public:
  virtual ~Robot() = default;

  virtual RobotState state() const = 0;
  virtual Pose2 pose() const = 0;
  virtual Twist2 twist() const = 0;  ///< Of the base frame's origin, in the base frame.
};

/// The base as a rigid body of Bullet.
class RobotBase final : public Robot {
 public:
  /// `ground` is a static body that outlives this.
  RobotBase(const RobotBlueprint& blueprint, const RobotState& state, btRigidBody& ground);

  void addTo(btDiscreteDynamicsWorld& world);
  void setTarget(const Twist2& robot_twist) { servo_->setTarget(robot_twist); }

  RobotState state() const override;
  Pose2 pose() const override;
  Twist2 twist() const override;

 private:
  const RobotBlueprint& blueprint_;
  std::unique_ptr<btRigidBody> body_;
  std::unique_ptr<PlanarServo> servo_;
};

}  // namespace casepush::sim
