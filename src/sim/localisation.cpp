#include "localisation.h"

#include <algorithm>
#include <cmath>

namespace casepush::sim {
namespace {

constexpr double kBound = 3.0;             // Of the localisation error, in standard deviations.
constexpr double kScaleDeviation = 0.005;  // Of the wheels' radius.

Twist2 scaled(const Twist2& twist, double factor) {
  return {factor * twist.vx_mps, factor * twist.vy_mps, factor * twist.wz_rps};
}

}  // namespace

Localisation::Localisation(const SimulatorOptions& options, const Pose2& map_T_robot)
    : noise_(options.sensor_noise),
      sigma_m_(options.localisation_sigma_m),
      sigma_rad_(options.localisation_sigma_rad),
      correlation_s_(options.localisation_correlation_s),
      random_(Random::stream(options.seed, "localisation")),
      map_T_robot_(map_T_robot) {
  if (!noise_) return;
  scale_ = 1.0 + std::clamp(random_.normal(kScaleDeviation), -kBound * kScaleDeviation,
                            kBound * kScaleDeviation);
  update(1e9, map_T_robot,
         {});  // Much longer than the correlation: a draw from the stationary law.
}

void Localisation::update(double step_s, const Pose2& map_T_robot, const Twist2& robot_twist) {
  const Eigen::Vector3d moved = logSe2(map_T_robot_.inverse() * map_T_robot);
  odom_T_robot_ = odom_T_robot_ * expSe2(scale_ * moved);
  map_T_robot_ = map_T_robot;
  robot_twist_ = scaled(robot_twist, scale_);
  if (!noise_) return;
  const double decay = std::exp(-step_s / correlation_s_);
  const double gain = std::sqrt(1.0 - decay * decay);
  const Eigen::Vector3d sigma(sigma_m_, sigma_m_, sigma_rad_);
  for (int i = 0; i < 3; ++i) {
    const double next = decay * error_[i] + gain * random_.normal(sigma[i]);
    error_[i] = std::clamp(next, -kBound * sigma[i], kBound * sigma[i]);
  }
}

void Localisation::relocate(const Pose2& map_T_robot) {
  map_T_robot_ = map_T_robot;
  robot_twist_ = {};
}

OdometryReading Localisation::reading(double time_s) const {
  const Pose2 map_T_estimated_robot = map_T_robot_ * expSe2(error_);
  return {time_s, map_T_estimated_robot * odom_T_robot_.inverse(), odom_T_robot_, robot_twist_};
}

}  // namespace casepush::sim
