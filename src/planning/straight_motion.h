#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casepush/world/collision_checker.h"

namespace casepush {

/// How deep a solid may overlap the map, the outside and each obstacle during a motion [m].
class AllowedDepth {
 public:
  /// As deep as at a pose.
  AllowedDepth(const CollisionChecker& checker, const Footprint& footprint, const Pose2& pose);

  bool covers(const Contact& contact) const;

 private:
  double map_m_ = 0.0;
  double outside_m_ = 0.0;
  std::vector<double> obstacles_m_;
};

/// Checks straight motions of the robot's true shape in small steps.
class StraightMotion {
 public:
  StraightMotion(const CollisionChecker& checker, const Footprint& footprint, AllowedDepth allowed)
      : checker_(checker), footprint_(footprint), allowed_(std::move(allowed)) {}

  /// What the motion from `from` (not included) to `to` overlaps too deeply first; nothing if it is
  /// fine. Steps are at most 1 cm and 2 degrees.
  std::optional<Contact> firstBlock(const Pose2& from, const Pose2& to) const;

 private:
  const CollisionChecker& checker_;
  const Footprint& footprint_;
  AllowedDepth allowed_;
};

/// Pose at fraction `t` of a straight motion with an even turn.
Pose2 between(const Pose2& from, const Pose2& to, double t);

}  // namespace casepush
