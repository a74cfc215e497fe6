#pragma once

#include <cstddef>
#include <vector>

#include "casepush/model/robot_model.h"
#include "motion_control.h"

namespace casepush {

/// Moves a reference along a path of straight segments within the robot's limits: slow around
/// corners, so that the robot stays on the path that was checked, and slow on the last stretch.
class PathFollower {
 public:
  struct Speeds {
    double cruise_mps;
    double dock_mps;
  };
  PathFollower(std::vector<Pose2> waypoints, const RobotLimits& limits, const Speeds& speeds);

  /// Moves on by `dt_s`, unless the robot lags behind too far.
  Reference advance(double dt_s, const Pose2& map_T_robot);

  bool atEnd() const { return travelled_ >= total(); }
  bool docking() const { return total() - travelled_ <= dock_length_; }
  double remaining() const { return total() - travelled_; }

 private:
  // Lengths are metres of travel; where the robot turns a lot, as many as take the same time.
  double total() const { return reach_.back(); }
  std::size_t nextWaypoint() const;
  /// So that it can brake for what comes after `travelled`, which is before the waypoint.
  double speedBefore(std::size_t waypoint, double travelled) const;
  Reference reference() const;

  Speeds speeds_;
  std::vector<Pose2> waypoints_;
  std::vector<double> reach_;         ///< Length from the start to each waypoint.
  std::vector<double> corner_speed_;  ///< Highest speed at each waypoint.
  std::vector<double> acceleration_;  ///< Highest one before each waypoint but the first.
  double dock_length_ = 0.0;
  double travelled_ = 0.0;
  double speed_ = 0.0;
};

}  // namespace casepush
