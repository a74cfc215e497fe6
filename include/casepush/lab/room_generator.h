#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "casepush/model/catalog.h"

namespace casepush {

struct RoomOptions {
  std::uint64_t seed = 1;
  double size_m = 10.0;  ///< Edge length of the square room, outer walls included.
  double density = 0.1;  ///< Share of the floor that furniture covers, walls not counted.
  std::string object = "office_chair";
  std::vector<std::string> movable;  ///< Other objects among the furniture, by name or URDF file.
  std::string robot = "cobot";
  void validate() const;  ///< @throws InputError listing every violation.
};

/// A square room with furniture at random places, one object, the robot beside it, and a goal.
///
/// A way of two straight legs from start to goal is laid out first and furniture is put where it
/// leaves that way free: at both ends and at the bend the robot can drive all around the object,
/// and the object passes between them at any heading. So start and goal are free and connected.
/// Nothing but the options matters: the same options give the same room.
/// @throws InputError from the catalog; if the room is too small for the object; or if the
/// furniture
///   does not fit beside the way.
WorldModel generateRoom(const Catalog& catalog, const RoomOptions& options);

}  // namespace casepush
