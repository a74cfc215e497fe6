#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "casepush/model/case.h"

namespace casepush {

class Sweep;

/// What planning needs of a case, worked out once. All poses are in the start frame.
struct PreparedCase {
  std::int64_t id = 0;
  PoseGaussian start_outcome;
  std::vector<Pose2> start_T_sigma;    ///< Sigma points besides the mean (paper eq. 5, 6).
  std::vector<Pose2> start_T_object;   ///< Mean object trajectory, in the order to be checked.
  std::vector<Pose2> start_T_robot;    ///< Robot trajectory, in the order to be checked.
  std::vector<Pose2> object_path;      ///< start_T_object in the order of the motion.
  std::vector<Pose2> robot_path;       ///< start_T_robot in the order of the motion.
  std::shared_ptr<const Sweep> sweep;  ///< Of all of these, if somebody prepared it.
  Pose2 robot_begin;                   ///< start_T_robot when the push starts.
  Pose2 outcome_T_robot;               ///< Where the robot stops, seen from the resting object.
  double push_direction_rad = 0.0;     ///< Heading of the robot's first motion in the start frame.
  double duration_s = 0.0;             ///< Of the push and of the object's coasting.
};

/// Step of prepareCases in cells of the map: nothing of a cell's size slips through.
constexpr double kStepPerCell = 0.5;

/// Prepares a case for collision checking.
///
/// Trajectories are re-sampled so that no point of the body moves more than `step_m` between
/// neighbouring poses, and ordered coarse to fine, so that most collisions show early.
/// @param zeta  Spread of the sigma points; 0 leaves the mean only.
/// @pre The case passes validateCase; step_m > 0.
PreparedCase prepareCase(const Case& push_case, double zeta, double step_m, double object_radius_m,
                         double robot_radius_m);

/// The same for several cases.
std::vector<PreparedCase> prepareCases(const std::vector<Case>& cases, double zeta, double step_m,
                                       double object_radius_m, double robot_radius_m);

}  // namespace casepush
