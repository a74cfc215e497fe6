#pragma once

#include <vector>

#include "casepush/common/pose2.h"

namespace casepush {

/// How two trajectories over the same ground correspond, whatever their timing.
struct TrajectoryAlignment {
  double cost = 0.0;           ///< Sum of squared distances of matched poses [m^2].
  std::vector<double> places;  ///< For each pose of the reference, ascending: its index in the
                               ///< other trajectory; a fraction lies between two poses.
};

/// Turns yaw into metres when poses of a trajectory are compared: about the radius of gyration of
/// furniture.
inline constexpr double kAlignmentYawScaleM = 0.3;

/// Dynamic time warping (Sakoe and Chiba, 1978; the paper's reference 23): the monotone matching of
/// all poses of both, first with first and last with last, whose squared distances
/// dx^2 + dy^2 + (yaw_scale dyaw)^2 have the least sum. A pose matched with several is taken to
/// correspond to the middle of them. Cost: O(n m) time, n m bytes.
/// @pre Neither is empty; poses are finite.
TrajectoryAlignment alignTrajectories(const std::vector<Pose2>& reference,
                                      const std::vector<Pose2>& other,
                                      double yaw_scale_m = kAlignmentYawScaleM);

/// The poses of a trajectory at fractional indices, on the screw motions between its poses.
/// @pre All places are in [0, trajectory.size() - 1].
std::vector<Pose2> posesAt(const std::vector<Pose2>& trajectory, const std::vector<double>& places);

/// Share of the way behind each pose of a trajectory, from 0 at the first to 1 at the last, as the
/// distance above measures it; by index if it does not move at all.
std::vector<double> travelledShares(const std::vector<Pose2>& trajectory,
                                    double yaw_scale_m = kAlignmentYawScaleM);

}  // namespace casepush
