#include "short_way.h"

#include <cmath>

#include "straight_motion.h"

namespace casepush {
namespace {

// How far before the dock pose it may begin to dock, the best first. Docking is slow.
constexpr double kDock_m[] = {0.03, 0.06, 0.1, 0.15, 0.2, 0.0};
// From less than this far off it docks at once.
constexpr double kThere_m = 0.1;
constexpr double kThere_rad = 0.15;
// Of the way to there, on which it may still be as close to something as it stands.
constexpr double kLeaving = 0.3;

}  // namespace

std::vector<Pose2> shortWay(const CollisionChecker& checker, const Footprint& docking,
                            const Pose2& start, const Pose2& goal, double direction_rad) {
  const StraightMotion leave(checker, docking, {checker, docking, start});
  const StraightMotion dock(checker, docking, {checker, docking, goal});
  const bool is_there =
      distance(start, goal) < kThere_m && std::abs(yawDifference(start, goal)) < kThere_rad;
  for (const double back_m : kDock_m) {
    if (is_there && back_m > 0.0) continue;
    const Pose2 before(goal.x() - back_m * std::cos(direction_rad),
                       goal.y() - back_m * std::sin(direction_rad), goal.yaw());
    const bool is_free = back_m == 0.0 || !checker.collides(docking, before);
    if (!is_free || dock.firstBlock(before, goal)) continue;
    const Pose2 left = between(start, before, kLeaving);
    if (leave.firstBlock(start, left) || dock.firstBlock(left, before)) continue;
    return back_m == 0.0 ? std::vector<Pose2>{start, goal}
                         : std::vector<Pose2>{start, before, goal};
  }
  return {};
}

}  // namespace casepush
