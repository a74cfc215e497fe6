#include <string>

#include "casepush/lab/sim_benchmark.h"
#include "casepush/world/static_map.h"
#include "thread_time.h"

namespace casepush {
namespace {

/// CPU time of a run in which the robot stands among the furniture and looks.
double lookingSeconds(const Catalog& catalog, const WorldModel& world, const RobotModel& robot,
                      double simulated_s) {
  std::map<std::string, ObjectModel> models;
  for (const ObjectPlacement& placement : world.objects) {
    models.emplace(placement.model, catalog.object(placement.model));
  }
  SimulatorOptions options;
  options.caster_model = CasterModel::kPlanar;  // Physics at rest is then next to nothing.
  Simulator simulator(world, robot, models, options);
  simulator.setScanning(true);
  const double start_s = threadSeconds();
  while (simulator.time() < simulated_s) simulator.step();
  return threadSeconds() - start_s;
}

}  // namespace

SensorCost measureSensorCost(const Catalog& catalog, const std::string& world_name,
                             double simulated_s) {
  const WorldModel world = loadWorld(catalog, world_name);
  RobotModel blind = catalog.robot(world.robot);
  RobotModel scanning = blind;
  RobotModel looking = blind;
  blind.cameras.clear();
  blind.range_sensors.clear();
  scanning.cameras.clear();
  looking.range_sensors.clear();
  double rays = 0.0;
  double images = 0.0;
  for (const RangeSensorModel& sensor : scanning.range_sensors) {
    rays += sensor.rays() * sensor.rate_hz * simulated_s;
  }
  for (const CameraModel& camera : looking.cameras) images += camera.rate_hz * simulated_s;
  const double base_s = lookingSeconds(catalog, world, blind, simulated_s);
  const double scan_s = lookingSeconds(catalog, world, scanning, simulated_s) - base_s;
  const double image_s = lookingSeconds(catalog, world, looking, simulated_s) - base_s;
  return {rays > 0.0 ? scan_s / rays : 0.0, images > 0.0 ? image_s / images : 0.0,
          scan_s / simulated_s};
}

}  // namespace casepush
