#pragma once

#include "casepush/common/yaml_reader.h"
#include "casepush/model/robot_model.h"

namespace casepush {

/// Reads the keys `cameras`, `range_sensors`, `odometry` and `localisation` of a robot's file.
/// @pre robot.solid is known.
/// @throws InputError naming file, key and bound.
void readSensors(YamlReader& reader, RobotModel& robot);

}  // namespace casepush
