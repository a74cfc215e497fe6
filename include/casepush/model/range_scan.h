#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace casepush {

/// What a range sensor measured at one instant.
struct RangeScan {
  std::string sensor;    ///< Name of the robot's range sensor.
  double stamp_s = 0.0;  ///< When it was measured.
  int layers = 0;
  int beams = 0;
  /// In the sensor's frame [m], layer by layer; NaN where a beam brought no return.
  std::vector<Eigen::Vector3f> points;
};

}  // namespace casepush
