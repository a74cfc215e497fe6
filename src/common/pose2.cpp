#include "casepush/common/pose2.h"

#include <cmath>

namespace casepush {
namespace {

constexpr double kSmallAngle = 1e-6;

}  // namespace

double wrapAngle(double angle_rad) {
  if (angle_rad > -M_PI && angle_rad <= M_PI) return angle_rad;  // Mostly.
  const double wrapped = std::remainder(angle_rad, 2.0 * M_PI);
  return wrapped <= -M_PI ? wrapped + 2.0 * M_PI : wrapped;
}

bool Twist2::isFinite() const {
  return std::isfinite(vx_mps) && std::isfinite(vy_mps) && std::isfinite(wz_rps);
}

double Twist2::speed() const { return std::hypot(vx_mps, vy_mps); }

Pose2::Pose2(double x_m, double y_m, double yaw_rad)
    : x_m_(x_m), y_m_(y_m), yaw_rad_(wrapAngle(yaw_rad)) {}

Pose2 Pose2::inverse() const {
  const double c = std::cos(yaw_rad_);
  const double s = std::sin(yaw_rad_);
  return {-c * x_m_ - s * y_m_, s * x_m_ - c * y_m_, -yaw_rad_};
}

bool Pose2::isFinite() const {
  return std::isfinite(x_m_) && std::isfinite(y_m_) && std::isfinite(yaw_rad_);
}

Pose2 operator*(const Pose2& a_T_b, const Pose2& b_T_c) {
  const Eigen::Vector2d p = a_T_b * b_T_c.position();
  return {p.x(), p.y(), a_T_b.yaw_rad_ + b_T_c.yaw_rad_};
}

Eigen::Vector2d operator*(const Pose2& a_T_b, const Eigen::Vector2d& p_b) {
  const double c = std::cos(a_T_b.yaw_rad_);
  const double s = std::sin(a_T_b.yaw_rad_);
  return {a_T_b.x_m_ + c * p_b.x() - s * p_b.y(), a_T_b.y_m_ + s * p_b.x() + c * p_b.y()};
}

Eigen::Vector3d logSe2(const Pose2& pose) {
  const double w = pose.yaw();
  // V^-1 = [a b; -b a] with b = w/2 and a = b / tan(b), which tends to 1 at w = 0.
  const double half = 0.5 * w;
  const double a = std::abs(w) < kSmallAngle ? 1.0 - w * w / 12.0 : half / std::tan(half);
  return {a * pose.x() + half * pose.y(), -half * pose.x() + a * pose.y(), w};
}

Pose2 expSe2(const Eigen::Vector3d& tangent) {
  const double w = tangent.z();
  double sinc = 1.0 - w * w / 6.0;
  double cosc = 0.5 * w;
  if (std::abs(w) >= kSmallAngle) {
    sinc = std::sin(w) / w;
    const double sin_half = std::sin(0.5 * w);
    cosc = 2.0 * sin_half * sin_half / w;  // (1 - cos w) / w without the cancellation
  }
  return {sinc * tangent.x() - cosc * tangent.y(), cosc * tangent.x() + sinc * tangent.y(), w};
}

Eigen::Matrix3d adjointSe2(const Pose2& pose) {
  const double c = std::cos(pose.yaw());
  const double s = std::sin(pose.yaw());
  Eigen::Matrix3d adjoint;
  adjoint << c, -s, pose.y(), s, c, -pose.x(), 0.0, 0.0, 1.0;
  return adjoint;
}

Pose2 interpolate(const Pose2& a, const Pose2& b, double t) {
  return a * expSe2(t * logSe2(a.inverse() * b));
}

double distance(const Pose2& a, const Pose2& b) { return (a.position() - b.position()).norm(); }

double yawDifference(const Pose2& a, const Pose2& b) { return wrapAngle(b.yaw() - a.yaw()); }

Twist2 rotate(const Twist2& twist, double a_yaw_b_rad) {
  const double c = std::cos(a_yaw_b_rad);
  const double s = std::sin(a_yaw_b_rad);
  return {c * twist.vx_mps - s * twist.vy_mps, s * twist.vx_mps + c * twist.vy_mps, twist.wz_rps};
}

}  // namespace casepush
