#pragma once

#include <vector>

#include "casepush/world/collision_checker.h"

namespace casepush {

/// The way to a dock pose beside which the robot already stands: it turns while it backs off, and
/// docks straight, without driving around.
///
/// For the first part of the way the robot comes no closer to anything than where it stands. Then
/// it keeps the docking margin, on longer ways the one for travelling, until it docks: there it
/// comes no closer than at the dock pose. Where nothing else is possible, it docks from where it
/// stands, if it stands apart.
/// @param docking  The robot grown by the docking margin.
/// @param travelling  The robot grown by the margin that it keeps at speed.
/// @param direction_rad  Of docking, in the map.
/// @return  Waypoints from `start` to `goal`, as the robot moves straight and turns evenly between
///   them; empty if there is no such way.
std::vector<Pose2> shortWay(const CollisionChecker& checker, const Footprint& docking,
                            const Footprint& travelling, const Pose2& start, const Pose2& goal,
                            double direction_rad);

}  // namespace casepush
