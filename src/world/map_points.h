#pragma once

#include <octomap/octomap_types.h>

#include <Eigen/Core>
#include <sstream>
#include <string>

namespace casepush {

inline octomap::point3d toOctomap(const Eigen::Vector3f& point) {
  return {point.x(), point.y(), point.z()};
}

/// "(1, 2, 0.5)"
inline std::string describe(const Eigen::Vector3f& point) {
  std::ostringstream stream;
  stream << "(" << point.x() << ", " << point.y() << ", " << point.z() << ")";
  return stream.str();
}

}  // namespace casepush
