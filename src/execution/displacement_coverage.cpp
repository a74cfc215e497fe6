#include "casepush/execution/displacement_coverage.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "casepush/common/check.h"
#include "casepush/common/halton.h"

namespace casepush {
namespace {

constexpr int kWanted = 512;
constexpr int kReachPoses = 2000;

}  // namespace

double toleranceDistance(const Pose2& a, const Pose2& b, const GoalTolerance& tolerance) {
  return std::hypot(distance(a, b) / tolerance.position_m, yawDifference(a, b) / tolerance.yaw_rad);
}

DisplacementCoverage::DisplacementCoverage(const Region& region) {
  for (int i = 1; i <= kWanted; ++i) {
    const Eigen::Vector3d at = halton(i);
    const double bearing = 2.0 * M_PI * at.x();
    const double length_m = region.min_m + at.y() * (region.max_m - region.min_m);
    wanted_.emplace_back(length_m * std::cos(bearing), length_m * std::sin(bearing),
                         region.max_yaw_rad * (2.0 * at.z() - 1.0));
    distance_.push_back(toleranceDistance(wanted_.back(), Pose2()));
  }
}

void DisplacementCoverage::add(const Pose2& start_T_object) {
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    distance_[i] = std::min(distance_[i], toleranceDistance(wanted_[i], start_T_object));
  }
}

double DisplacementCoverage::gain(const Pose2& start_T_object) const {
  double gain = 0.0;
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    gain += std::max(0.0, distance_[i] - toleranceDistance(wanted_[i], start_T_object));
  }
  return gain / static_cast<double>(wanted_.size());
}

double DisplacementCoverage::meanDistance() const {
  return std::accumulate(distance_.begin(), distance_.end(), 0.0) /
         static_cast<double>(distance_.size());
}

double reachableShare(const std::vector<Pose2>& displacements, int pushes, double radius_m,
                      const GoalTolerance& tolerance) {
  CASEPUSH_CHECK(pushes >= 1 && pushes <= 3, "chains of " << pushes << " pushes");
  std::vector<Pose2> reached{Pose2()};
  std::size_t shorter = 0;
  for (int i = 0; i < pushes; ++i) {
    const std::size_t count = reached.size();
    for (std::size_t from = shorter; from < count; ++from) {
      const Pose2 start = reached[from];
      for (const Pose2& displacement : displacements) {
        reached.push_back(start * displacement);
      }
    }
    shorter = count;
  }
  int hits = 0;
  for (int i = 1; i <= kReachPoses; ++i) {
    const Eigen::Vector3d at = halton(i);
    const double bearing = 2.0 * M_PI * at.x();
    const double length_m = radius_m * std::sqrt(at.y());
    const Pose2 goal(length_m * std::cos(bearing), length_m * std::sin(bearing),
                     wrapAngle(2.0 * M_PI * at.z()));
    hits += std::any_of(reached.begin(), reached.end(),
                        [&](const Pose2& pose) { return tolerance.isMet(goal, pose); })
                ? 1
                : 0;
  }
  return static_cast<double>(hits) / kReachPoses;
}

}  // namespace casepush
