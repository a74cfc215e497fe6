#include "rounded_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace casepush {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoLength_m = 1e-6;
constexpr double kStraight_rad = 0.01;
constexpr double kStep_rad = 0.1;
constexpr double kSagitta_m = 0.0005;

struct Corner {
  double turn_rad = 0.0;  ///< Between the directions of travel, to the left.
  double radius_m = 0.0;
  double tangent_m = 0.0;  ///< From the corner to where the arc begins, and to where it ends.
};

Corner cornerAt(const Pose2& before, const Pose2& at, const Pose2& after, double cut_m,
                const CornerLimits& limits) {
  const Eigen::Vector2d in = at.position() - before.position();
  const Eigen::Vector2d out = after.position() - at.position();
  Corner corner;
  if (in.norm() < kNoLength_m || out.norm() < kNoLength_m) return corner;
  corner.turn_rad = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
  const double half_rad = std::abs(corner.turn_rad) / 2.0;
  if (half_rad < kStraight_rad / 2.0) {
    corner.radius_m = kInfinity;
    return corner;
  }
  const double radius_m = std::min(cut_m * std::cos(half_rad) / (1.0 - std::cos(half_rad)),
                                   std::min(in.norm(), out.norm()) / 2.0 / std::tan(half_rad));
  const double sharp_mps = limits.step_mps / (2.0 * std::sin(half_rad));
  if (std::sqrt(limits.acceleration_mps2 * radius_m) > sharp_mps) {
    corner.radius_m = radius_m;
    corner.tangent_m = radius_m * std::tan(half_rad);
  }
  return corner;
}

Pose2 along(const Pose2& from, const Pose2& to, double length_m) {
  const double t = length_m / distance(from, to);
  const Eigen::Vector2d position = from.position() + t * (to.position() - from.position());
  return {position.x(), position.y(), from.yaw() + t * yawDifference(from, to)};
}

}  // namespace

RoundedPath roundCorners(const std::vector<Pose2>& waypoints, const CornerLimits& limits) {
  RoundedPath path;
  const auto add = [&path](const Pose2& pose, double radius_m) {
    path.waypoints.push_back(pose);
    path.radius_m.push_back(radius_m);
  };
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    if (i == 0 || i + 1 == waypoints.size()) {
      add(waypoints[i], kInfinity);
      continue;
    }
    const bool is_end = i == 1 || i + 2 == waypoints.size();
    const Corner corner = cornerAt(waypoints[i - 1], waypoints[i], waypoints[i + 1],
                                   is_end ? limits.end_cut_m : limits.cut_m, limits);
    if (corner.tangent_m == 0.0) {
      add(waypoints[i], corner.radius_m);
      continue;
    }
    const Pose2 begin = along(waypoints[i], waypoints[i - 1], corner.tangent_m);
    const Pose2 end = along(waypoints[i], waypoints[i + 1], corner.tangent_m);
    const Eigen::Vector2d in = (waypoints[i].position() - waypoints[i - 1].position()).normalized();
    const double left = corner.turn_rad > 0.0 ? corner.radius_m : -corner.radius_m;
    const Eigen::Vector2d centre_m = begin.position() + left * Eigen::Vector2d(-in.y(), in.x());
    const double step_rad = std::min(kStep_rad, std::sqrt(8.0 * kSagitta_m / corner.radius_m));
    const int steps = static_cast<int>(std::ceil(std::abs(corner.turn_rad) / step_rad));
    // The arc before may end where this one begins.
    const bool is_there = distance(path.waypoints.back(), begin) < kNoLength_m;
    if (is_there) path.radius_m.back() = std::min(path.radius_m.back(), corner.radius_m);
    for (int k = is_there ? 1 : 0; k <= steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      const Eigen::Vector2d position =
          centre_m + Eigen::Rotation2Dd(t * corner.turn_rad) * (begin.position() - centre_m);
      add({position.x(), position.y(), begin.yaw() + t * yawDifference(begin, end)},
          corner.radius_m);
    }
  }
  return path;
}

}  // namespace casepush
