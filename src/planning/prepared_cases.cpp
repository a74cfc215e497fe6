#include "casepush/planning/prepared_cases.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "casepush/common/check.h"

namespace casepush {
namespace {

// Poses of a trajectory such that no point within `radius_m` moves more than `step_m` in between.
std::vector<Pose2> resample(const std::vector<Pose2>& poses, double step_m, double radius_m) {
  std::vector<Pose2> result = {poses.front()};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Pose2 from = result.back();
    const double motion_m =
        distance(from, poses[i]) + radius_m * std::abs(yawDifference(from, poses[i]));
    if (motion_m < step_m && i + 1 < poses.size()) {
      continue;  // The next pose is compared with the last one kept, so that nothing adds up.
    }
    const double pieces_needed = std::ceil(motion_m / step_m);
    CASEPUSH_CHECK(pieces_needed <= std::numeric_limits<int>::max(),
                   "a motion of " << motion_m << " m in steps of " << step_m << " m");
    const int pieces = std::max(1, static_cast<int>(pieces_needed));
    for (int k = 1; k <= pieces; ++k) {
      result.push_back(interpolate(from, poses[i], static_cast<double>(k) / pieces));
    }
  }
  return result;
}

// The last pose, then every 16th, then the 8ths in between, and so on.
std::vector<Pose2> coarseToFine(const std::vector<Pose2>& poses) {
  std::vector<Pose2> result = {poses.back()};
  std::vector<bool> taken(poses.size(), false);
  taken.back() = true;
  for (std::size_t stride = 16; stride > 0; stride /= 2) {
    for (std::size_t i = 0; i < poses.size(); i += stride) {
      if (!taken[i]) {
        taken[i] = true;
        result.push_back(poses[i]);
      }
    }
  }
  return result;
}

}  // namespace

PreparedCase prepareCase(const Case& push_case, double zeta, double step_m, double object_radius_m,
                         double robot_radius_m) {
  CASEPUSH_CHECK(step_m > 0.0, "step " << step_m);
  CASEPUSH_CHECK(!push_case.steps.empty(), "case " << push_case.id << " has no steps");
  PreparedCase prepared;
  prepared.id = push_case.id;
  prepared.start_outcome = push_case.start_outcome;
  if (zeta > 0.0) {
    const auto sigma = sigmaPoints(push_case.start_outcome, zeta);
    prepared.start_T_sigma.assign(sigma.begin() + 1, sigma.end());
  }
  std::vector<Pose2> object;
  std::vector<Pose2> robot;
  for (const CaseStep& step : push_case.steps) {
    object.push_back(step.start_T_object);
    robot.push_back(step.start_T_robot());
  }
  prepared.object_path = resample(object, step_m, object_radius_m);
  prepared.robot_path = resample(robot, step_m, robot_radius_m);
  prepared.start_T_object = coarseToFine(prepared.object_path);
  prepared.start_T_robot = coarseToFine(prepared.robot_path);
  prepared.robot_begin = robot.front();
  // As recorded: with the mean outcome, which was learnt later, the two might overlap.
  prepared.outcome_T_robot = push_case.steps.back().object_T_robot;
  prepared.push_direction_rad = pushDirection(push_case);
  prepared.duration_s = push_case.durationS();
  return prepared;
}

std::vector<PreparedCase> prepareCases(const std::vector<Case>& cases, double zeta, double step_m,
                                       double object_radius_m, double robot_radius_m) {
  std::vector<PreparedCase> prepared;
  prepared.reserve(cases.size());
  for (const Case& push_case : cases) {
    prepared.push_back(prepareCase(push_case, zeta, step_m, object_radius_m, robot_radius_m));
  }
  return prepared;
}

}  // namespace casepush
