#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <array>
#include <memory>
#include <vector>

#include "planar_body.h"
#include "robot_base.h"

namespace casepush::sim {

/// The base in the plane, driven like PlanarServo drives it: each axis has its own force limit.
class PlanarRobot final : public Robot {
 public:
  PlanarRobot(const RobotBlueprint& blueprint, const RobotState& state);

  void addTo(btCollisionWorld& world);
  void setTarget(const Twist2& robot_twist) { target_ = robot_twist; }

  /// Before each step: gives the solver its velocities, and rows for the drives.
  void enter(double step_s, PlanarSolver& solver);
  /// After each step: moves.
  void leave(double step_s, PlanarSolver& solver);

  const PlanarBody& body() const { return body_; }

  RobotState state() const override;
  Pose2 pose() const override;
  Twist2 twist() const override;

 private:
  void placeCollider();

  const RobotBlueprint& blueprint_;
  PlanarBody body_;
  Twist2 target_;
  std::array<double, 3> impulse_ns_{};  // Of the drives in the step before.
  std::size_t first_drive_ = 0;
  btCollisionObject collider_;
};

}  // namespace casepush::sim
