#pragma once

#include <vector>

#include "casepush/world/collision_checker.h"

namespace casepush {

/// The way to a dock pose beside which the robot already stands: it turns while it backs off, and
/// docks straight, without driving around.
///
/// The robot comes no closer to anything than where it stands, and keeps the docking margin but for
/// the first part of the way; docking, it comes no closer than at the dock pose.
/// @param docking  The robot grown by the docking margin.
/// @param direction_rad  Of docking, in the map.
/// @return  Waypoints from `start` to `goal`, as the robot moves straight and turns evenly between
///   them; empty if there is no such way.
std::vector<Pose2> shortWay(const CollisionChecker& checker, const Footprint& docking,
                            const Pose2& start, const Pose2& goal, double direction_rad);

}  // namespace casepush
