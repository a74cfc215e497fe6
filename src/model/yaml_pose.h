#pragma once

#include <Eigen/Geometry>

#include "casepush/common/pose2.h"
#include "casepush/common/yaml_reader.h"

namespace casepush {

/// Radians of `<key>` given in degrees, within [low_deg, high_deg].
double readAngle(YamlReader& reader, const std::string& key, double low_deg, double high_deg);

/// Keys `xy` [m] and `yaw_deg` of a planar pose.
Pose2 readPose2(YamlReader& reader);

/// Keys `xyz` [m, within 10] and `rpy_deg` [within 360]: roll, pitch, yaw about the fixed x, y, z
/// axes, as in URDF.
Eigen::Isometry3d readPose3(YamlReader& reader);

}  // namespace casepush
