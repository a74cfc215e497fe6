#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "casepush/model/catalog.h"

namespace casepush {

struct DividedRoomOptions {
  std::uint64_t seed = 1;
  double size_m = 10.0;   ///< Edge length of the square room, outer walls included.
  double density = 0.03;  ///< Share of the floor that static furniture covers.
  double door_m = 2.1;    ///< Width of both doors.
  std::string object = "overbed_table";
  std::vector<std::string> movable = {"office_chair", "utility_cart"};  ///< In the near door.
  std::string robot = "cobot";
  void validate() const;  ///< @throws InputError listing every violation.
};

/// A square room that a wall with two doors divides. Start and goal lie on the two sides of the
/// near door, in which movable objects stand; the far door is open. So there are two ways: the
/// short one has to be cleared, the long one is free (the setting of the paper's table 1, which
/// shows none of its own). Furniture stands at random beside both. Same options, same room.
/// @throws InputError from the catalog, or if the room is too small.
WorldModel generateDividedRoom(const Catalog& catalog, const DividedRoomOptions& options);

}  // namespace casepush
