#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <vector>

namespace casepush {

/// Reads a point cloud in the PCD format of the Point Cloud Library, versions up to 0.7.
/// @throws InputError naming `where` and what is wrong.
std::vector<Eigen::Vector3f> readPcd(std::istream& stream, const std::string& where);

}  // namespace casepush
