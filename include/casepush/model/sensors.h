#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

namespace casepush {

/// What every simulated sensor has. docs/simulator.md has the equations.
struct SensorSwitches {
  bool enabled = true;     ///< False: the sensor is not there.
  bool noise = true;       ///< False: exact, and nothing drops out; latency stays.
  std::uint64_t seed = 0;  ///< Of its noise; 0: derived from the simulator's seed and its name.
};

/// A pinhole camera that finds tags. Its optical frame is REP 103's: x right, y down, z forward.
struct CameraModel {
  std::string name;
  SensorSwitches switches;
  Eigen::Isometry3d base_T_camera = Eigen::Isometry3d::Identity();
  int width_px = 640;
  int height_px = 480;
  double horizontal_fov_rad = 1.2;
  double rate_hz = 20.0;
  double latency_s = 0.0;  ///< From the exposure, which the stamp tells, to the detections.
  double max_range_m = 5.0;
  double max_view_angle_rad = 1.2;  ///< Between the tag's normal and the line of sight.
  double corner_noise_px = 0.3;     ///< Standard deviation of each tag corner in the image.
  double dropout = 0.02;            ///< Probability that a visible tag is not reported.

  double focalPx() const;
};

/// A range finder that scans planes or cones about its z axis; x points forward (REP 103).
struct RangeSensorModel {
  std::string name;
  SensorSwitches switches;
  Eigen::Isometry3d base_T_sensor = Eigen::Isometry3d::Identity();
  int beams = 360;  ///< Of each layer, from right to left.
  int layers = 1;   ///< From low to high.
  double horizontal_fov_rad = 2.0 * M_PI;
  double vertical_fov_rad = 0.0;  ///< Between the lowest and the highest layer.
  double min_range_m = 0.05;
  double max_range_m = 10.0;
  double rate_hz = 10.0;
  double latency_s = 0.0;
  double noise_m = 0.01;         ///< Standard deviation of a range, and
  double noise_per_range = 0.0;  ///< what it grows by with each metre of range.
  double dropout = 0.0;          ///< Probability that a beam brings no return.

  /// Unit vector of a beam in the sensor's frame. @pre 0 <= layer < layers, 0 <= beam < beams.
  Eigen::Vector3d direction(int layer, int beam) const;
  int rays() const { return beams * layers; }
};

/// Odometry from wheels: each velocity is off by a factor and by noise, and their integral drifts.
///
/// Scales are drawn once for each run. The others are standard deviations after one metre or one
/// full turn; they grow with the square root of either.
struct OdometryModel {
  SensorSwitches switches;
  double scale = 0.005;       ///< Standard deviation of the factor of distances.
  double turn_scale = 0.005;  ///< The same of turns.
  double position_per_metre_m = 0.002;
  double position_per_turn_m = 0.002;
  double yaw_per_metre_rad = 0.003;
  double yaw_per_turn_rad = 0.01;
};

/// Localisation in the map: its error wanders slowly (Ornstein-Uhlenbeck) within hard bounds.
struct LocalisationModel {
  SensorSwitches switches;
  double position_sigma_m = 0.004;  ///< Along each of the map's axes.
  double yaw_sigma_rad = 0.002;
  double correlation_s = 10.0;      ///< Time within which correlation falls to 1/e.
  double position_bound_m = 0.012;  ///< Of the length of the position's error.
  double yaw_bound_rad = 0.006;
};

}  // namespace casepush
