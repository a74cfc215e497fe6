#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace casepush {

constexpr std::uint64_t kMostCloudPoints = 20'000'000;

/// @throws InputError naming `where` if there are too many to take.
void checkCloudSize(std::uint64_t points, const std::string& where);

/// @throws InputError naming `where` and `place`, e.g. "point 7", if it is not finite.
void checkCloudPoint(const Eigen::Vector3f& point, const std::string& where,
                     const std::string& place);

/// Reads points as lines of numbers up to the end of the stream.
/// @param columns  Which of a line's numbers are x, y and z.
/// @param line_number  Of the line before the first.
/// @throws InputError naming `where` and the line.
std::vector<Eigen::Vector3f> readPointLines(std::istream& stream, const std::array<int, 3>& columns,
                                            std::uint64_t line_number, const std::string& where);

/// @throws InputError naming `where` and the line.
std::vector<Eigen::Vector3f> readXyz(std::istream& stream, const std::string& where);

}  // namespace casepush
