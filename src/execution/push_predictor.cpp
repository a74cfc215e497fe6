#include "push_predictor.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kPeriodS = 0.05;
// Pushes that the first guess of a gain is worth.
constexpr double kPriorPushes = 2.0;
constexpr double kOffRad = 1.1;

}  // namespace

PushPredictor::PushPredictor(const ObjectModel& object, const RobotModel& robot)
    : gyration_radius_m_(object.gyration_radius_m),
      robot_radius_m_(robot.radius_m),
      limits_(robot.limits) {}

void PushPredictor::Gain::learn(double seen, double observed, double scale) {
  seen_observed += seen * observed / (scale * scale);
  seen_squared += seen * seen / (scale * scale);
  gain = (kPriorPushes + seen_observed) / (kPriorPushes + seen_squared);
}

PushPredictor::Course PushPredictor::quasiStatic(const PushConfiguration& push) const {
  const PushTrajectory trajectory = pushTrajectory(push, limits_, kPeriodS);
  const Pose2& start = trajectory.start_T_robot.front();
  // The point of the robot that is nearest to the object's centre touches first.
  const Eigen::Vector2d to_object = -start.position().normalized();
  const double reach_m = std::min(robot_radius_m_, start.position().norm());
  const Eigen::Vector2d robot_contact =
      start.inverse() * Eigen::Vector2d(start.position() + reach_m * to_object);
  const double inertia = gyration_radius_m_ * gyration_radius_m_;
  Pose2 object;
  Eigen::Vector2d contact = start * robot_contact;
  for (std::size_t i = 1; i < trajectory.start_T_robot.size(); ++i) {
    const Eigen::Vector2d moved = trajectory.start_T_robot[i] * robot_contact;
    const Eigen::Vector2d arm = contact - object.position();
    // motion = k (f + (arm x f) / rho^2 (z x arm)), solved for k f, the motion of the centre.
    const Eigen::Vector2d across(-arm.y(), arm.x());
    const Eigen::Matrix2d mobility =
        Eigen::Matrix2d::Identity() + across * across.transpose() / inertia;
    const Eigen::Vector2d step = mobility.inverse() * (moved - contact);
    object = Pose2(object.x() + step.x(), object.y() + step.y(),
                   object.yaw() + across.dot(step) / inertia);
    contact = moved;
  }
  const Pose2& end = trajectory.start_T_robot.back();
  const Eigen::Vector2d to_end_object = object.position() - end.position();
  return {logSe2(object), wrapAngle(std::atan2(to_end_object.y(), to_end_object.x()) - end.yaw() -
                                    push.direction_rad)};
}

bool PushPredictor::slidesOff(const PushConfiguration& push) const {
  return std::abs(quasiStatic(push).off_rad) > kOffRad;
}

Pose2 PushPredictor::predict(const PushConfiguration& push) const {
  Eigen::Vector3d motion = quasiStatic(push).motion;
  motion.head<2>() *= translation_.gain;
  motion.z() = std::clamp(motion.z() * rotation_.gain, -3.0, 3.0);
  return expSe2(motion);
}

void PushPredictor::learn(const PushConfiguration& push, const Pose2& start_T_object) {
  const Eigen::Vector3d expected = quasiStatic(push).motion;
  const Eigen::Vector3d observed = logSe2(start_T_object);
  const double length_m = expected.head<2>().norm();
  if (length_m > 1e-3) {
    translation_.learn(length_m, observed.head<2>().dot(expected.head<2>()) / length_m, 0.5);
  }
  rotation_.learn(expected.z(), observed.z(), 0.5);
}

}  // namespace casepush
