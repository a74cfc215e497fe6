#include "sensors.h"

namespace casepush::sim {

Sensors::Sensors(const Scene& scene, bool noise, std::uint64_t seed)
    : sight(scene),
      cameras(scene, noise, seed),
      range_sensors(scene, noise, seed),
      localisation(scene.robot, noise, seed, scene.world.map_T_robot) {}

void Sensors::update(double time_s, double step_s, const PhysicsWorld& physics, bool scanning) {
  const Robot& robot = physics.robot();
  localisation.update(step_s, robot.pose(), robot.twist());
  const bool scan = scanning && range_sensors.isDue(time_s);
  if (!scan) range_sensors.skip(time_s);
  if (!scan && !cameras.isDue(time_s)) return;
  sight.look(physics);
  cameras.update(time_s, physics, sight);
  if (scan) range_sensors.update(time_s, robot.pose(), sight);
}

}  // namespace casepush::sim
