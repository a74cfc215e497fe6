#include "odometry.h"

#include <algorithm>
#include <cmath>

namespace casepush::sim {
namespace {

constexpr double kMostDeviations = 3.0;  // Of a scale: no wheel is far from its size.
// Encoders are read this often: noise of the velocity stays the same in between.
constexpr double kHold_s = 0.02;

double drawScale(Random& random, double sigma) {
  return 1.0 + std::clamp(random.normal(sigma), -kMostDeviations * sigma, kMostDeviations * sigma);
}

}  // namespace

Odometry::Odometry(const OdometryModel& model, bool noise, Random random)
    : model_(model), noise_(noise && model.switches.noise), random_(random) {
  if (!noise_) return;
  scale_.x() = scale_.y() = drawScale(random_, model.scale);
  scale_.z() = drawScale(random_, model.turn_scale);
}

Eigen::Vector3d Odometry::velocityNoise(double step_s, const Eigen::Vector3d& velocity) {
  const int held = std::max(1, static_cast<int>(std::lround(kHold_s / step_s)));
  if (steps_++ % held == 0) {
    for (double& value : draw_) value = random_.normal(1.0);
  }
  // Constant over the time T = held * step_s, a velocity of standard deviation k sqrt(v / T) moves
  // by k sqrt(v T): what k says after the distance v T.
  const double per_s = 1.0 / (held * step_s);
  const double metres = velocity.head<2>().norm() * per_s;
  const double turns = std::abs(velocity.z()) / (2.0 * M_PI) * per_s;
  const auto sigma = [&](double per_metre, double per_turn) {
    return std::sqrt(per_metre * per_metre * metres + per_turn * per_turn * turns);
  };
  const double position = sigma(model_.position_per_metre_m, model_.position_per_turn_m);
  const double yaw = sigma(model_.yaw_per_metre_rad, model_.yaw_per_turn_rad);
  return draw_.cwiseProduct(Eigen::Vector3d(position, position, yaw));
}

void Odometry::update(double step_s, const Eigen::Vector3d& moved, const Twist2& twist) {
  Eigen::Vector3d noise = Eigen::Vector3d::Zero();
  if (noise_) noise = velocityNoise(step_s, moved / step_s);
  odom_T_robot_ = odom_T_robot_ * expSe2(scale_.cwiseProduct(moved) + step_s * noise);
  const Eigen::Vector3d measured =
      scale_.cwiseProduct(Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps)) + noise;
  twist_ = {measured.x(), measured.y(), measured.z()};
}

}  // namespace casepush::sim
