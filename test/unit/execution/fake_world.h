#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/execution/execute_push.h"
#include "casepush/model/object_model.h"

namespace casepush::test {

inline constexpr double kRobotRadiusM = 0.3;
inline constexpr double kObjectRadiusM = 0.35;
inline constexpr double kGyrationRadiusM = 0.25;

inline Solid disc(double radius_m) {
  PlacedShape shape{Cylinder{radius_m, 1.0}, Eigen::Isometry3d::Identity(), "body"};
  shape.frame_T_shape.translation().z() = 0.5;
  return {shape};
}

inline RobotModel fakeRobot() {
  RobotModel robot;
  robot.name = "disc_robot";
  robot.solid = disc(kRobotRadiusM);
  robot.radius_m = kRobotRadiusM;
  return robot;
}

inline ObjectModel fakeObject() {
  ObjectModel object;
  object.name = "disc";
  object.solid = disc(kObjectRadiusM);
  object.radius_m = kObjectRadiusM;
  object.gyration_radius_m = kGyrationRadiusM;
  return object;
}

/// A planar world without dynamics: the robot follows commands with a lag, an object that it
/// overlaps is shifted out of the way along the contact normal and turns about its friction centre,
/// and coasts afterwards. Poses are observed with noise, the object's at 20 Hz.
class FakeWorld {
 public:
  explicit FakeWorld(std::uint64_t seed) : random_(seed) {}

  // Everything may be set by tests.
  Pose2 robot{-1.5, 0.0, 0.0};
  Pose2 object;
  Twist2 object_velocity;  ///< In the map.
  double deceleration_mps2 = 0.6;
  double scatter = 0.0;                         ///< Relative scatter of each push's effect.
  Eigen::Vector2d friction_centre{0.08, 0.03};  ///< In the object frame.
  double noise_m = 0.002;
  double noise_rad = 0.003;
  bool object_fixed = false;
  bool robot_blocked = false;
  bool object_visible = true;
  bool robot_localised = true;
  double now_s = 100.0;

  static constexpr double kTickS = 0.02;

  Observation observe() {
    if (robot_localised) {
      seen_robot_ = noisy(robot);
      robot_stamp_s_ = now_s;
    }
    if (object_visible && now_s - seen_object_.stamp_s > 0.049) {
      seen_object_.id = "chair_1";
      seen_object_.model = "disc";
      seen_object_.map_T_object = noisy(object);
      seen_object_.covariance =
          Eigen::Vector3d(noise_m, noise_m, noise_rad).cwiseAbs2().asDiagonal();
      seen_object_.twist = rotate(object_velocity, -object.yaw());
      seen_object_.stamp_s = now_s;
      seen_object_.moving =
          object_velocity.speed() > 0.03 || std::abs(object_velocity.wz_rps) > 0.06;
    }
    Observation observation;
    observation.stamp_s = now_s;
    observation.map_T_robot = seen_robot_;
    observation.robot_stamp_s = robot_stamp_s_;
    observation.robot_twist = robot_twist_;
    if (seen_object_.stamp_s > 0.0) {
      observation.objects.push_back(seen_object_);
    }
    return observation;
  }

  void advance(const Twist2& command) {
    constexpr int kSubsteps = 4;
    constexpr double kStepS = kTickS / kSubsteps;
    for (int i = 0; i < kSubsteps; ++i) {
      robot_twist_ = lag(robot_twist_, command, kStepS / 0.06);
      if (!robot_blocked) {
        robot = robot * expSe2(kStepS * Eigen::Vector3d(robot_twist_.vx_mps, robot_twist_.vy_mps,
                                                        robot_twist_.wz_rps));
      }
      moveObject(kStepS);
    }
    now_s += kTickS;
  }

  bool touching() const { return distance(robot, object) < kRobotRadiusM + kObjectRadiusM + 1e-6; }

 private:
  Pose2 noisy(const Pose2& pose) {
    return pose *
           Pose2(random_.normal(noise_m), random_.normal(noise_m), random_.normal(noise_rad));
  }

  static Twist2 lag(const Twist2& from, const Twist2& to, double share) {
    return {from.vx_mps + share * (to.vx_mps - from.vx_mps),
            from.vy_mps + share * (to.vy_mps - from.vy_mps),
            from.wz_rps + share * (to.wz_rps - from.wz_rps)};
  }

  void moveObject(double dt_s) {
    if (object_fixed) {
      return;
    }
    const Pose2 before = object;
    coast(dt_s);
    const Eigen::Vector2d between = object.position() - robot.position();
    const double overlap = kRobotRadiusM + kObjectRadiusM - between.norm();
    if (overlap > 0.0) {
      push(between.normalized(), overlap);
      object_velocity = {(object.x() - before.x()) / dt_s, (object.y() - before.y()) / dt_s,
                         yawDifference(before, object) / dt_s};
    }
  }

  void push(const Eigen::Vector2d& normal, double overlap) {
    if (now_s - last_contact_s_ > 1.0) {
      gain_ = 1.0 + random_.normal(scatter);
    }
    last_contact_s_ = now_s;
    const Eigen::Vector2d centre = object * friction_centre;
    const Eigen::Vector2d arm = object.position() - kObjectRadiusM * normal - centre;
    const double torque = arm.x() * normal.y() - arm.y() * normal.x();
    const double share = overlap / (1.0 + torque * torque / (kGyrationRadiusM * kGyrationRadiusM));
    const double turn = gain_ * share * torque / (kGyrationRadiusM * kGyrationRadiusM);
    const Eigen::Vector2d new_centre = centre + share * normal;
    const double yaw = object.yaw() + turn;
    const Eigen::Vector2d position =
        new_centre - Eigen::Rotation2Dd(yaw).toRotationMatrix() * friction_centre;
    object = Pose2(position.x(), position.y(), yaw);
  }

  void coast(double dt_s) {
    const double speed =
        std::max(object_velocity.speed(), kGyrationRadiusM * std::abs(object_velocity.wz_rps));
    const double left = std::max(0.0, speed - deceleration_mps2 / gain_ * dt_s);
    const double share = speed > 0.0 ? left / speed : 0.0;
    object_velocity = {share * object_velocity.vx_mps, share * object_velocity.vy_mps,
                       share * object_velocity.wz_rps};
    object = Pose2(object.x() + dt_s * object_velocity.vx_mps,
                   object.y() + dt_s * object_velocity.vy_mps,
                   object.yaw() + dt_s * object_velocity.wz_rps);
  }

  Random random_;
  Twist2 robot_twist_;
  Pose2 seen_robot_;
  double robot_stamp_s_ = 0.0;
  ObjectState seen_object_;
  double last_contact_s_ = -10.0;
  double gain_ = 1.0;
};

inline RobotPath pathThrough(std::vector<Pose2> waypoints) {
  RobotPath path;
  path.found = true;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    path.length_m += distance(waypoints[i - 1], waypoints[i]);
  }
  path.waypoints = std::move(waypoints);
  return path;
}

/// Backs off from the object, drives around it on a circle, and docks straight.
inline RobotPath detour(const Observation& observation, const Pose2& goal,
                        double dock_direction_rad) {
  constexpr double kCircleM = 1.0;
  const Pose2 centre = observation.objects.front().map_T_object;
  const auto bearing = [&centre](const Pose2& pose) {
    return std::atan2(pose.y() - centre.y(), pose.x() - centre.x());
  };
  const Pose2 before(goal.x() - 0.3 * std::cos(dock_direction_rad),
                     goal.y() - 0.3 * std::sin(dock_direction_rad), goal.yaw());
  std::vector<Pose2> waypoints{observation.map_T_robot};
  const double from = bearing(observation.map_T_robot);
  const double sweep = wrapAngle(bearing(before) - from);
  const int count = 1 + static_cast<int>(std::abs(sweep) / 0.4);
  for (int i = std::abs(sweep) < 0.1 ? count : 0; i <= count; ++i) {
    const double angle = from + sweep * i / count;
    waypoints.emplace_back(centre.x() + kCircleM * std::cos(angle),
                           centre.y() + kCircleM * std::sin(angle), goal.yaw());
  }
  waypoints.push_back(before);
  waypoints.push_back(goal);
  return pathThrough(std::move(waypoints));
}

/// The same, which counts how often it is asked.
inline ApproachPlanner countedDetour(int* asked) {
  return [asked](const Observation& observation, const Pose2& goal, double dock_direction_rad) {
    ++*asked;
    return detour(observation, goal, dock_direction_rad);
  };
}

/// A push straight along the object's +x, from behind.
inline PushConfiguration straightPush() {
  PushConfiguration push;
  push.object_T_robot = Pose2(-kObjectRadiusM - kRobotRadiusM - 0.03, 0.0, 0.0);
  return push;
}

/// Ticks until the behaviour ends or `limit_s` has passed. `watch` sees each observation and tick.
inline BehaviourStatus run(Behaviour& behaviour, FakeWorld& world, double limit_s = 120.0,
                           const std::function<void(const Observation&, const Tick&)>& watch = {}) {
  const double end_s = world.now_s + limit_s;
  while (world.now_s < end_s) {
    const Observation observation = world.observe();
    const Tick tick = behaviour.tick(observation);
    if (watch) {
      watch(observation, tick);
    }
    if (tick.status != BehaviourStatus::kRunning) {
      return tick.status;
    }
    world.advance(tick.command.twist);
  }
  return BehaviourStatus::kRunning;
}

/// Ticks until the push is in a phase. False if it ended before.
inline bool runUntil(ExecutePush& push, FakeWorld& world, ExecutePush::Phase phase,
                     double limit_s = 60.0) {
  const double end_s = world.now_s + limit_s;
  while (push.phase() != phase && world.now_s < end_s) {
    const Tick tick = push.tick(world.observe());
    if (tick.status != BehaviourStatus::kRunning) {
      return push.phase() == phase;
    }
    world.advance(tick.command.twist);
  }
  return push.phase() == phase;
}

inline bool isZero(const Twist2& twist) {
  return twist.vx_mps == 0.0 && twist.vy_mps == 0.0 && twist.wz_rps == 0.0;
}

}  // namespace casepush::test
