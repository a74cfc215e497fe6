#pragma once

#include <array>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/model/object_model.h"

namespace casepush {

/// Where an object about which little is known will roughly end up.
///
/// The robot's front sticks to the object's side in one point, about which the object is free to
/// turn; its resistance is that of an ellipsoidal limit surface with the gyration radius (Goyal,
/// Ruina and Papadopoulos 1991). What an object makes of it in translation and in rotation,
/// friction and coasting included, are two gains that are learnt from the pushes seen.
class PushPredictor {
 public:
  PushPredictor(const ObjectModel& object, const RobotModel& robot);

  /// Rough resting pose in the start frame.
  Pose2 predict(const PushConfiguration& push) const;

  /// True if the robot will probably turn or pass by the object before the push ends.
  bool slidesOff(const PushConfiguration& push) const;

  void learn(const PushConfiguration& push, const Pose2& start_T_object);

 private:
  struct Course {
    Eigen::Vector3d motion;  ///< Logarithm of the object's displacement while in contact.
    double off_rad;          ///< Bearing of the object off the robot's last motion.
  };
  Course quasiStatic(const PushConfiguration& push) const;

  struct Gain {
    double gain;
    double seen_observed = 0.0;
    double seen_squared = 0.0;
    void learn(double seen, double observed, double scale);
  };
  double gyration_radius_m_;
  double robot_radius_m_;
  RobotLimits limits_;
  Gain translation_{1.0};
  Gain rotation_{1.0};
};

}  // namespace casepush
