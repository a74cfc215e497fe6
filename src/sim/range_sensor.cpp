#include "range_sensor.h"

#include <algorithm>
#include <limits>

#include "bullet_conversions.h"

namespace casepush::sim {
namespace {

constexpr std::size_t kMostWaiting = 100;

}  // namespace

RangeSensors::RangeSensors(const Scene& scene, bool noise, std::uint64_t seed)
    : noise_(noise), seed_(seed), waiting_(kMostWaiting) {
  for (const RangeSensorModel& model : scene.robot.range_sensors) {
    if (!model.switches.enabled) continue;
    Sensor sensor{&model, {}, SampleClock(model.rate_hz)};
    for (int layer = 0; layer < model.layers; ++layer) {
      for (int beam = 0; beam < model.beams; ++beam) {
        sensor.directions.push_back(model.direction(layer, beam));
      }
    }
    sensors_.push_back(std::move(sensor));
  }
}

bool RangeSensors::isDue(double time_s) const {
  return std::any_of(sensors_.begin(), sensors_.end(),
                     [time_s](const Sensor& sensor) { return sensor.clock.isDue(time_s); });
}

void RangeSensors::update(double time_s, const Pose2& map_T_robot, const Sight& sight) {
  for (Sensor& sensor : sensors_) {
    if (!sensor.clock.isDue(time_s)) continue;
    waiting_.push(time_s + sensor.model->latency_s, measure(sensor, time_s, map_T_robot, sight));
    sensor.clock.advance(time_s);
  }
}

void RangeSensors::skip(double time_s) {
  for (Sensor& sensor : sensors_) {
    if (sensor.clock.isDue(time_s)) sensor.clock.advance(time_s);
  }
}

Random RangeSensors::streamOf(const Sensor& sensor) const {
  return noiseStream(sensor.model->switches, seed_,
                     sensor.model->name + " scan " + std::to_string(sensor.clock.samples()));
}

RangeScan RangeSensors::measure(const Sensor& sensor, double time_s, const Pose2& map_T_robot,
                                const Sight& sight) const {
  constexpr float kNoReturn = std::numeric_limits<float>::quiet_NaN();
  const RangeSensorModel& model = *sensor.model;
  const bool noise = noise_ && model.switches.noise;
  Random random = streamOf(sensor);
  const Eigen::Isometry3d map_T_sensor = toSpatial(map_T_robot) * model.base_T_sensor;
  RangeScan scan{model.name, time_s, model.layers, model.beams, {}};
  scan.points.reserve(sensor.directions.size());
  for (const Eigen::Vector3d& direction : sensor.directions) {
    scan.points.emplace_back(kNoReturn, kNoReturn, kNoReturn);
    const Sight::Hit hit = sight.cast(map_T_sensor.translation(), map_T_sensor.linear() * direction,
                                      model.max_range_m);
    double range_m = hit.range_m;
    if (hit.is_robot || range_m > model.max_range_m) continue;
    if (noise) {
      if (random.chance(model.dropout)) continue;
      range_m += random.normal(model.noise_m + model.noise_per_range * range_m);
    }
    if (range_m < model.min_range_m || range_m > model.max_range_m) continue;
    scan.points.back() = (range_m * direction).cast<float>();
  }
  return scan;
}

}  // namespace casepush::sim
