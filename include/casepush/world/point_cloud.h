#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace casepush {

/// Points of a .pcd file (ASCII or binary; fields x, y, z of type float or double) or of a .xyz
/// file (three numbers or more on each line, separated by blanks or commas; # begins a comment).
/// Everything else in the file is passed over, a .pcd file's viewpoint included.
/// @throws InputError naming the file, and line or point: missing, no such format, truncated,
///   damaged, without a point, a point that is not finite, more than 20 million points.
std::vector<Eigen::Vector3f> loadPointCloud(const std::filesystem::path& file);

}  // namespace casepush
