#include "straight_motion.h"

#include <algorithm>
#include <cmath>

namespace casepush {
namespace {

constexpr double kStep_m = 0.01;
constexpr double kStep_rad = 2.0 * M_PI / 180.0;
/// Depths of the same overlap, reckoned at two poses, differ by rounding.
constexpr double kSameDepth_m = 1e-6;

}  // namespace

AllowedDepth::AllowedDepth(const CollisionChecker& checker, const Footprint& footprint,
                           const Pose2& pose)
    : obstacles_m_(checker.obstacles().size(), 0.0) {
  for (const Contact& contact : checker.contacts(footprint, pose)) {
    if (contact.with == Contact::With::kMap) map_m_ = contact.depth_m;
    if (contact.with == Contact::With::kOutside) outside_m_ = contact.depth_m;
    if (contact.with == Contact::With::kObstacle) obstacles_m_[contact.obstacle] = contact.depth_m;
  }
}

bool AllowedDepth::covers(const Contact& contact) const {
  double allowed_m = map_m_;
  if (contact.with == Contact::With::kOutside) allowed_m = outside_m_;
  if (contact.with == Contact::With::kObstacle) allowed_m = obstacles_m_[contact.obstacle];
  return contact.depth_m <= allowed_m + kSameDepth_m;
}

std::optional<Contact> StraightMotion::firstBlock(const Pose2& from, const Pose2& to) const {
  const double steps_needed =
      std::max(distance(from, to) / kStep_m, std::abs(yawDifference(from, to)) / kStep_rad);
  const int steps = std::max(1, static_cast<int>(std::ceil(steps_needed)));
  for (int i = 1; i <= steps; ++i) {
    const Pose2 pose = between(from, to, static_cast<double>(i) / steps);
    if (!checker_.collides(footprint_, pose)) continue;
    for (const Contact& contact : checker_.contacts(footprint_, pose)) {
      if (!allowed_.covers(contact)) return contact;
    }
  }
  return std::nullopt;
}

Pose2 between(const Pose2& from, const Pose2& to, double t) {
  const Eigen::Vector2d position = from.position() + t * (to.position() - from.position());
  return {position.x(), position.y(), wrapAngle(from.yaw() + t * yawDifference(from, to))};
}

}  // namespace casepush
