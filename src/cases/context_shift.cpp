#include "casepush/cases/context_shift.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "casepush/cases/case_tube.h"
#include "guess.h"

namespace casepush {
namespace {

Eigen::Vector3d coordinates(const Pose2& pose) { return {pose.x(), pose.y(), pose.yaw()}; }

/// Turns a covariance of x, y, yaw between frames that differ by `yaw_rad`.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, double yaw_rad) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  rotation.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return rotation * covariance * rotation.transpose();
}

}  // namespace

ContextShift::ContextShift(const ContextShiftOptions& options) : options_(options) {
  const Eigen::Vector3d position(options.position_per_m, options.position_per_m,
                                 options.position_per_rad);
  const Eigen::Vector3d yaw(options.yaw_per_m, options.yaw_per_m, options.yaw_per_rad);
  for (int axis = 0; axis < 3; ++axis) {
    precision_[axis] = (axis < 2 ? position : yaw).cwiseAbs2().cwiseInverse().asDiagonal();
    information_[axis].setZero();
  }
}

void ContextShift::add(const Case& before, const Case& now) {
  const Pose2& mean = before.start_outcome.mean;
  const Eigen::Vector3d feature = coordinates(mean);
  const Eigen::Vector3d change(now.start_outcome.mean.x() - mean.x(),
                               now.start_outcome.mean.y() - mean.y(),
                               yawDifference(mean, now.start_outcome.mean));
  const Eigen::Matrix3d scatter = turned(before.start_outcome.covariance, mean.yaw());
  for (int axis = 0; axis < 3; ++axis) {
    const double unexplained = axis < 2 ? options_.unexplained_m : options_.unexplained_rad;
    const double noise =
        unexplained * unexplained + scatter(axis, axis) / std::max(1.0, now.effective_count);
    precision_[axis] += feature * feature.transpose() / noise;
    information_[axis] += feature * (change(axis) / noise);
  }
}

Case ContextShift::conjecture(Case push_case) const {
  const Pose2& mean = push_case.start_outcome.mean;
  const Eigen::Vector3d feature = coordinates(mean);
  Eigen::Vector3d change;
  Eigen::Matrix3d uncertainty = Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::LDLT<Eigen::Matrix3d> solver(precision_[axis]);
    const double unexplained = axis < 2 ? options_.unexplained_m : options_.unexplained_rad;
    change(axis) = feature.dot(solver.solve(information_[axis]));
    uncertainty(axis, axis) = unexplained * unexplained + feature.dot(solver.solve(feature));
  }
  const Pose2 moved(mean.x() + change.x(), mean.y() + change.y(), mean.yaw() + change.z());
  push_case.start_outcome.mean = moved;
  makeGuess(&push_case, push_case.start_outcome.covariance, turned(uncertainty, -moved.yaw()));
  push_case.tube = tubeFromOutcome(push_case.steps, push_case.start_outcome, {});
  return push_case;
}

}  // namespace casepush
