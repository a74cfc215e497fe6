#include "yaml_pose.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

constexpr double kRadPerDeg = M_PI / 180.0;
constexpr double kLargestCoordinate_m = 10.0;  // of what a model carries
constexpr double kLargestAngle_deg = 360.0;

std::vector<double> readThree(YamlReader& reader, const char* key, double largest,
                              const char* unit) {
  const std::vector<double> values = reader.numbers(key, 3);
  for (const double value : values) {
    if (std::abs(value) > largest) {
      std::ostringstream text;
      text << "holds " << value << "; each must be within " << largest << " " << unit << " of 0";
      throw InputError(reader.where(key), text.str());
    }
  }
  return values;
}

}  // namespace

double readAngle(YamlReader& reader, const std::string& key, double low_deg, double high_deg) {
  return kRadPerDeg * reader.number(key, low_deg, high_deg);
}

Pose2 readPose2(YamlReader& reader) {
  const std::vector<double> xy_m = reader.numbers("xy", 2);
  return {xy_m[0], xy_m[1], readAngle(reader, "yaw_deg", -360.0, 360.0)};
}

Eigen::Isometry3d readPose3(YamlReader& reader) {
  const std::vector<double> xyz_m = readThree(reader, "xyz", kLargestCoordinate_m, "m");
  const std::vector<double> rpy_deg = readThree(reader, "rpy_deg", kLargestAngle_deg, "deg");
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << xyz_m[0], xyz_m[1], xyz_m[2];
  pose.linear() = (Eigen::AngleAxisd(kRadPerDeg * rpy_deg[2], Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(kRadPerDeg * rpy_deg[1], Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(kRadPerDeg * rpy_deg[0], Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

}  // namespace casepush
