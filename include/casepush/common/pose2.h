#pragma once

#include <Eigen/Core>

namespace casepush {

/// Angle wrapped to (-pi, pi] [rad].
double wrapAngle(double angle_rad);

/// A planar velocity: x, y [m/s] and yaw rate [rad/s] in the frame its name says.
struct Twist2 {
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double wz_rps = 0.0;

  bool isFinite() const;
  double speed() const;  ///< Translational speed [m/s].
};

/// A pose in SE(2): position [m] and heading in (-pi, pi] [rad].
///
/// `a_T_b` maps b-coordinates to a-coordinates, so that `a_T_b * b_T_c == a_T_c`.
class Pose2 {
 public:
  Pose2() = default;
  Pose2(double x_m, double y_m, double yaw_rad);

  double x() const { return x_m_; }
  double y() const { return y_m_; }
  double yaw() const { return yaw_rad_; }
  Eigen::Vector2d position() const { return {x_m_, y_m_}; }

  Pose2 inverse() const;
  bool isFinite() const;

  friend Pose2 operator*(const Pose2& a_T_b, const Pose2& b_T_c);
  friend Eigen::Vector2d operator*(const Pose2& a_T_b, const Eigen::Vector2d& p_b);

 private:
  double x_m_ = 0.0;
  double y_m_ = 0.0;
  double yaw_rad_ = 0.0;
};

/// Logarithm of SE(2): the constant body twist (vx, vy, wz) that reaches `pose` in unit time.
/// Unique for |yaw| < pi. See Sola et al., "A micro Lie theory", 2018, eq. 158-161.
Eigen::Vector3d logSe2(const Pose2& pose);

/// Exponential of SE(2), the inverse of logSe2.
Pose2 expSe2(const Eigen::Vector3d& tangent);

/// Adjoint of SE(2): `exp(adjoint(T) * e) == T * exp(e) * T.inverse()`.
Eigen::Matrix3d adjointSe2(const Pose2& pose);

/// Pose at fraction `t` in [0, 1] on the screw motion from `a` to `b`.
Pose2 interpolate(const Pose2& a, const Pose2& b, double t);

/// Euclidean distance of the positions [m].
double distance(const Pose2& a, const Pose2& b);

/// Heading of `b` minus heading of `a`, wrapped to (-pi, pi] [rad].
double yawDifference(const Pose2& a, const Pose2& b);

/// `twist` given in frame b, expressed in frame a (rotation only; no lever arm).
Twist2 rotate(const Twist2& twist, double a_yaw_b_rad);

}  // namespace casepush
