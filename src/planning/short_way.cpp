#include "short_way.h"

#include <cmath>

#include "straight_motion.h"

namespace casepush {
namespace {

// How far before the dock pose it may begin to dock, the best first. Docking is slow.
constexpr double kDock_m[] = {0.03, 0.06, 0.1, 0.15, 0.2};
// From less than this far off it docks at once.
constexpr double kThere_m = 0.1;
constexpr double kThere_rad = 0.15;
// So short a way leaves no room to get fast.
constexpr double kSlow_m = 0.2;
// Of the way to there, on which it may still be as close to something as it stands.
constexpr double kLeaving = 0.3;

}  // namespace

std::vector<Pose2> shortWay(const CollisionChecker& checker, const Footprint& docking,
                            const Footprint& travelling, const Pose2& start, const Pose2& goal,
                            double direction_rad) {
  const StraightMotion leave(checker, docking, {checker, docking, start});
  const StraightMotion dock(checker, docking, {checker, docking, goal});
  const bool is_there =
      distance(start, goal) < kThere_m && std::abs(yawDifference(start, goal)) < kThere_rad;
  const bool is_direct = !checker.collides(docking, start) && !dock.firstBlock(start, goal);
  if (is_there && is_direct) return {start, goal};
  for (const double back_m : kDock_m) {
    const Pose2 before(goal.x() - back_m * std::cos(direction_rad),
                       goal.y() - back_m * std::sin(direction_rad), goal.yaw());
    const bool is_slow = distance(start, before) < kSlow_m;
    const Footprint& wanted = is_slow ? docking : travelling;
    if (checker.collides(wanted, before)) continue;
    const StraightMotion between_sides(checker, wanted, {checker, wanted, before});
    const Pose2 left = between(start, before, kLeaving);
    if (leave.firstBlock(start, left) || between_sides.firstBlock(left, before)) continue;
    if (!dock.firstBlock(before, goal)) return {start, before, goal};
  }
  return is_direct ? std::vector<Pose2>{start, goal} : std::vector<Pose2>{};
}

}  // namespace casepush
