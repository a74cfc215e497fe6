#pragma once

#include <Eigen/Core>
#include <array>

#include "tag_measurement.h"

namespace casepush {

/// Pose and velocity of one object with a hypothesis test between resting and moving.
///
/// Interacting multiple models (Blom and Bar-Shalom 1988) with two modes: at rest (the pose creeps
/// by the drift of the robot's localisation) and constant velocity in the map. The state is x, y,
/// yaw and their rates in map axes, so both modes are linear; only yaw wraps.
class MotionFilter {
 public:
  struct Noise {
    double acceleration_mps2;
    double yaw_acceleration_rps2;
  };

  MotionFilter(const PoseMeasurement& measurement, double stamp_s, const Noise& noise);

  double stampS() const { return stamp_s_; }
  void predict(double stamp_s);

  /// Squared Mahalanobis distance of a measurement, by the mode that explains it best.
  double squaredDistance(const PoseMeasurement& measurement) const;
  void update(const PoseMeasurement& measurement);

  /// Mean and covariance over both modes.
  struct Estimate {
    Pose2 map_T_object;
    Eigen::Vector3d map_velocity;  ///< x, y [m/s], yaw [rad/s].
    Eigen::Matrix3d covariance;    ///< Of x, y, yaw in map axes.
    double moving_probability;
  };
  Estimate estimate() const;

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  struct Mode {
    Vector6 mean;
    Matrix6 covariance;
    double probability;
  };
  static Mode merge(const std::array<Mode, 2>& modes, const Eigen::Vector2d& weights);
  void mix(double dt_s);
  void propagateRest(double dt_s);
  void propagateMotion(double dt_s);

  Noise noise_;
  double stamp_s_;
  std::array<Mode, 2> modes_;  ///< At rest; moving.
};

}  // namespace casepush
