#include "motion_filter.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace casepush {
namespace {

constexpr int kRest = 0;
constexpr int kMoving = 1;

// Mode changes per second: pushes begin every few seconds and last about as long.
constexpr double kStartRate = 0.6;
constexpr double kStopRate = 0.5;
// Accelerations of a push persist for about this long: spectral density = variance x time.
constexpr double kAccelerationTimeS = 0.1;
// Creep of a resting object's pose in the map, from the robot's localisation [m^2/s], [rad^2/s].
constexpr double kRestDriftM2 = 4e-6;
constexpr double kRestDriftRad2 = 4e-6;
// First guess of an object's speed when it comes in sight.
constexpr double kInitialSpeedSigmaMps = 0.3;
constexpr double kInitialYawRateSigmaRps = 0.6;
// Longer gaps tell no more: the filter would only lose its numbers.
constexpr double kMaxGapS = 5.0;

}  // namespace

MotionFilter::MotionFilter(const PoseMeasurement& measurement, double stamp_s, const Noise& noise)
    : noise_(noise), stamp_s_(stamp_s) {
  const Pose2& pose = measurement.map_T_object;
  Mode mode;
  mode.mean << pose.x(), pose.y(), pose.yaw(), 0.0, 0.0, 0.0;
  mode.covariance = Matrix6::Zero();
  mode.covariance.topLeftCorner<3, 3>() = measurement.covariance;
  mode.probability = 0.5;
  modes_ = {mode, mode};
  modes_[kMoving].covariance.diagonal().tail<3>() =
      Eigen::Vector3d(kInitialSpeedSigmaMps, kInitialSpeedSigmaMps, kInitialYawRateSigmaRps)
          .cwiseAbs2();
}

MotionFilter::Mode MotionFilter::merge(const std::array<Mode, 2>& modes,
                                       const Eigen::Vector2d& weights) {
  // Deviations are taken from one mode, so that yaw may wrap.
  Vector6 offset = modes[1].mean - modes[0].mean;
  offset(2) = wrapAngle(offset(2));
  Mode merged;
  merged.mean = modes[0].mean + weights(1) * offset;
  merged.mean(2) = wrapAngle(merged.mean(2));
  merged.covariance = weights(0) * modes[0].covariance + weights(1) * modes[1].covariance +
                      weights(0) * weights(1) * offset * offset.transpose();
  merged.probability = 1.0;
  return merged;
}

void MotionFilter::mix(double dt_s) {
  const double start = 1.0 - std::exp(-kStartRate * dt_s);
  const double stop = 1.0 - std::exp(-kStopRate * dt_s);
  const double rest = modes_[kRest].probability;
  const double moving = modes_[kMoving].probability;
  const Eigen::Vector2d to_rest(rest * (1.0 - start), moving * stop);
  const Eigen::Vector2d to_moving(rest * start, moving * (1.0 - stop));
  const std::array<Mode, 2> before = modes_;
  modes_[kRest] = merge(before, to_rest / to_rest.sum());
  modes_[kMoving] = merge(before, to_moving / to_moving.sum());
  modes_[kRest].probability = to_rest.sum();
  modes_[kMoving].probability = to_moving.sum();
}

void MotionFilter::propagateRest(double dt_s) {
  Mode& mode = modes_[kRest];
  mode.mean.tail<3>().setZero();
  const Eigen::Matrix3d pose_covariance = mode.covariance.topLeftCorner<3, 3>();
  mode.covariance.setZero();
  mode.covariance.topLeftCorner<3, 3>() = pose_covariance;
  mode.covariance.diagonal().head<3>() +=
      dt_s * Eigen::Vector3d(kRestDriftM2, kRestDriftM2, kRestDriftRad2);
}

void MotionFilter::propagateMotion(double dt_s) {
  Mode& mode = modes_[kMoving];
  Matrix6 transition = Matrix6::Identity();
  transition.topRightCorner<3, 3>() = dt_s * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d density =
      kAccelerationTimeS * Eigen::Vector3d(noise_.acceleration_mps2, noise_.acceleration_mps2,
                                           noise_.yaw_acceleration_rps2)
                               .cwiseAbs2();
  const Eigen::Matrix3d q = density.asDiagonal();
  Matrix6 process;
  process << q * (dt_s * dt_s * dt_s / 3.0), q * (dt_s * dt_s / 2.0), q * (dt_s * dt_s / 2.0),
      q * dt_s;
  mode.mean = (transition * mode.mean).eval();
  mode.mean(2) = wrapAngle(mode.mean(2));
  mode.covariance = (transition * mode.covariance * transition.transpose() + process).eval();
}

void MotionFilter::predict(double stamp_s) {
  const double dt_s = std::min(stamp_s - stamp_s_, kMaxGapS);
  if (!(dt_s > 0.0)) {
    return;
  }
  mix(dt_s);
  propagateRest(dt_s);
  propagateMotion(dt_s);
  stamp_s_ = stamp_s;
}

namespace {

Eigen::Vector3d innovation(const Eigen::Vector3d& mean, const Pose2& measured) {
  return {measured.x() - mean.x(), measured.y() - mean.y(), wrapAngle(measured.yaw() - mean.z())};
}

}  // namespace

double MotionFilter::squaredDistance(const PoseMeasurement& measurement) const {
  double best = std::numeric_limits<double>::infinity();
  for (const Mode& mode : modes_) {
    const Eigen::Vector3d e = innovation(mode.mean.head<3>(), measurement.map_T_object);
    const Eigen::Matrix3d s = mode.covariance.topLeftCorner<3, 3>() + measurement.covariance;
    best = std::min(best, e.dot(s.inverse() * e));
  }
  return best;
}

void MotionFilter::update(const PoseMeasurement& measurement) {
  Eigen::Vector2d log_likelihood;
  for (int i = 0; i < 2; ++i) {
    Mode& mode = modes_[i];
    const Eigen::Vector3d e = innovation(mode.mean.head<3>(), measurement.map_T_object);
    const Eigen::Matrix3d s = mode.covariance.topLeftCorner<3, 3>() + measurement.covariance;
    const Eigen::Matrix3d s_inverse = s.inverse();
    log_likelihood(i) = -0.5 * (e.dot(s_inverse * e) + std::log(s.determinant()));
    const Eigen::Matrix<double, 6, 3> gain = mode.covariance.leftCols<3>() * s_inverse;
    mode.mean += gain * e;
    mode.mean(2) = wrapAngle(mode.mean(2));
    mode.covariance -= (gain * s * gain.transpose()).eval();
    mode.covariance = 0.5 * (mode.covariance + mode.covariance.transpose()).eval();
  }
  // Neither mode may die out: the next push must be able to revive it.
  constexpr double kLeastProbability = 1e-6;
  const double largest = log_likelihood.maxCoeff();
  double sum = 0.0;
  for (int i = 0; i < 2; ++i) {
    const double likelihood = std::exp(log_likelihood(i) - largest);
    modes_[i].probability = std::max(kLeastProbability, modes_[i].probability * likelihood);
    sum += modes_[i].probability;
  }
  modes_[kRest].probability /= sum;
  modes_[kMoving].probability /= sum;
}

MotionFilter::Estimate MotionFilter::estimate() const {
  const Mode merged =
      merge(modes_, Eigen::Vector2d(modes_[kRest].probability, modes_[kMoving].probability));
  return {Pose2(merged.mean(0), merged.mean(1), merged.mean(2)), merged.mean.tail<3>(),
          merged.covariance.topLeftCorner<3, 3>(), modes_[kMoving].probability};
}

}  // namespace casepush
