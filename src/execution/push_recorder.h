#pragma once

#include <string>
#include <vector>

#include "casepush/model/case.h"

namespace casepush {

/// Samples a push at a fixed period, interpolating between ticks.
class PushRecorder {
 public:
  PushRecorder(double period_s, const Pose2& map_T_start);

  /// @param t_s  Since the push began; the first call is at 0.
  void add(double t_s, const Pose2& map_T_robot, const Pose2& map_T_object, const Twist2& action);

  /// The pushing phase ends here: the latest sample is its last.
  void endPush();

  /// The recording as a case with the statistics of this one observation.
  /// @param rest_from_s  Since the push began: samples of an object at rest are left out, but for a
  ///   last one at its final pose.
  Case finish(double rest_from_s, const Pose2& map_T_end) const;

 private:
  struct Sample {
    double t_s;
    Pose2 map_T_robot;
    Pose2 map_T_object;
    Twist2 action;
  };
  double period_s_;
  Pose2 map_T_start_;
  std::vector<Sample> samples_;
  Sample latest_;
  int push_samples_ = 0;
};

}  // namespace casepush
