#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/case.h"

namespace casepush {

/// What synthetic pushes look like.
struct SyntheticPushOptions {
  std::string object = "chair";
  double contact_radius_m = 0.75;  ///< Between the centres of robot and object.
  double speed_mps = 0.3;
  double position_sigma_m = 0.03;
  double yaw_sigma_rad = 0.05;
};

/// One push: from `bearing` around the object, straight on for `duration_s`, while the object turns
/// by `turn_rad`. The object follows a screw motion; the robot keeps its place at the object's
/// side.
inline Case syntheticPush(std::int64_t id, double bearing_rad, double duration_s, double turn_rad,
                          const SyntheticPushOptions& options) {
  Case made;
  made.id = id;
  made.object = options.object;
  made.robot = "robot";
  made.period_s = 0.1;
  made.push_steps = static_cast<int>(std::lround(duration_s / made.period_s));
  const double length_m = options.speed_mps * duration_s;
  const Pose2 outcome(length_m * std::cos(bearing_rad + 0.5 * turn_rad),
                      length_m * std::sin(bearing_rad + 0.5 * turn_rad), turn_rad);
  const Pose2 object_T_robot(-options.contact_radius_m * std::cos(bearing_rad),
                             -options.contact_radius_m * std::sin(bearing_rad), bearing_rad);
  for (int i = 0; i <= made.push_steps; ++i) {
    CaseStep step;
    step.object_T_robot = object_T_robot;
    step.action =
        i < made.push_steps ? Twist2{options.speed_mps, 0.0, turn_rad / duration_s} : Twist2{};
    step.start_T_object = interpolate(Pose2(), outcome, static_cast<double>(i) / made.push_steps);
    made.steps.push_back(step);
  }
  made.start_outcome.mean = outcome;
  made.start_outcome.covariance =
      Eigen::Vector3d(options.position_sigma_m, options.position_sigma_m, options.yaw_sigma_rad)
          .array()
          .square()
          .matrix()
          .asDiagonal();
  made.effective_count = 20;
  made.observation_count = 20;
  return made;
}

/// `count` pushes from random sides, 1 to 3 s long, some straight and some turning, as exploration
/// would find them.
inline std::vector<Case> syntheticPushes(int count, std::uint64_t seed,
                                         const SyntheticPushOptions& options = {}) {
  Random random = Random::stream(seed, "synthetic pushes");
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    const double bearing = random.uniform(-3.14159, 3.14159);
    const double duration = random.uniform(1.0, 3.0);
    cases.push_back(syntheticPush(i + 1, bearing, duration, random.uniform(-0.8, 0.8), options));
  }
  return cases;
}

}  // namespace casepush
