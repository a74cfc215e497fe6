#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "casepush/planning/prepared_cases.h"

namespace casepush {

/// How long the robot takes between pushes, for comparing plans.
struct PushTimeOptions {
  double drive_speed_mps = 0.35;  ///< Average while driving around the object.
  double turn_rate_rps = 0.8;     ///< Average; the robot turns while it drives.
  double clearance_m = 0.25;      ///< Kept from the object's side while going around it.
  double handling_s = 4.0;        ///< For each push: undock, look, dock.
};

/// Expected time of pushes, and a lower bound of what is left.
class PushTime {
 public:
  PushTime(const std::vector<PreparedCase>& cases, const PushTimeOptions& options);

  /// Push `next` right after push `previous`, with the robot's way in between [s].
  double after(int previous, int next) const {
    return count_ > kTabled ? drive(end_[previous], begin_[next]) + duration_s_[next]
                            : step_s_[static_cast<std::size_t>(previous) * count_ + next];
  }

  /// Push `next` first, with the robot standing at `object_T_robot` [s].
  double first(const Pose2& object_T_robot, int next) const;

  /// The same if the robot's way there is at least `drive_m` long, around all that stands [s].
  double first(const Pose2& object_T_robot, int next, double drive_m) const;

  /// Driving so far, without anything else [s].
  double driveS(double length_m) const { return length_m / options_.drive_speed_mps; }

  /// No chain of pushes moves the object by `distance_m` in less time [s].
  double lowerBound(double distance_m) const {
    return best_speed_mps_ > 0.0 ? std::max(0.0, distance_m) / best_speed_mps_
                                 : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr std::size_t kTabled = 256;  // With more cases a table would be too large.

  double drive(const Pose2& object_T_from, const Pose2& object_T_to) const;

  PushTimeOptions options_;
  std::size_t count_;
  std::vector<Pose2> begin_;        // object_T_robot where each push starts
  std::vector<Pose2> end_;          // object_T_robot where each push ends
  std::vector<double> duration_s_;  // of each push
  std::vector<double> step_s_;      // after(previous, next); empty with many cases
  double best_speed_mps_ = 0.0;     // of the object, over whole pushes with their handling
};

}  // namespace casepush
