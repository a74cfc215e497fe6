#pragma once

#include <cstdint>
#include <vector>

#include "casepush/common/random.h"
#include "casepush/model/range_scan.h"
#include "scene.h"
#include "sensor_timing.h"
#include "sight.h"

namespace casepush::sim {

/// The robot's range sensors. All beams of a scan are measured at the same instant.
class RangeSensors {
 public:
  /// @pre `scene` outlives this.
  RangeSensors(const Scene& scene, bool noise, std::uint64_t seed);

  bool isDue(double time_s) const;

  /// Takes the scans that are due. The noise of each is a function of seed, name and number of the
  /// scan, so that it makes no difference whether earlier ones were skipped.
  void update(double time_s, const Pose2& map_T_robot, const Sight& sight);
  /// Passes over the scans that are due.
  void skip(double time_s);

  /// Those whose latency has passed, oldest first.
  std::vector<RangeScan> take(double time_s) { return waiting_.take(time_s); }

 private:
  struct Sensor {
    const RangeSensorModel* model;
    std::vector<Eigen::Vector3d> directions;
    SampleClock clock;
  };

  RangeScan measure(const Sensor& sensor, double time_s, const Pose2& map_T_robot,
                    const Sight& sight) const;
  Random streamOf(const Sensor& sensor) const;

  bool noise_;
  std::uint64_t seed_;
  std::vector<Sensor> sensors_;
  DelayLine<RangeScan> waiting_;
};

}  // namespace casepush::sim
