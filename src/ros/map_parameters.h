#pragma once

#include "casepush/ros/node_parameters.h"

namespace casepush {

/// Where the planner's map comes from and how it follows scans; docs/ros_api.md lists the keys.
void readMapParameters(ParameterReader& reader, MapParameters& map);

}  // namespace casepush
