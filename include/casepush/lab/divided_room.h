#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casepush/model/catalog.h"

namespace casepush {

struct DividedRoomOptions {
  std::uint64_t seed = 1;
  double size_m = 10.0;           ///< Along the dividing wall, outer walls included.
  std::optional<double> depth_m;  ///< Across it; nothing: a square room.
  double density = 0.03;          ///< Share of the floor that static furniture covers.
  double door_m = 2.1;            ///< Width of both doors.
  /// Between the middles of the doors; nothing: as far as the room allows.
  std::optional<double> doors_apart_m;
  double play_m = 0.5;  ///< Start and goal may lie so far beside the near door's axis.
  std::string object = "overbed_table";
  std::vector<std::string> movable = {"office_chair", "utility_cart"};  ///< In the near door.
  std::string robot = "cobot";
  void validate() const;  ///< @throws InputError listing every violation.
};

/// A room that a wall with two doors divides. Start and goal lie on the two sides of the near door,
/// in which movable objects stand; the far door is open. So there are two ways: the short one has
/// to be cleared, the long one is free. Furniture stands at random beside both. Same options, same
/// room.
/// @throws InputError from the catalog, or if the room is too small.
WorldModel generateDividedRoom(const Catalog& catalog, const DividedRoomOptions& options);

/// The same with measures and obstacles drawn at random by the seed: 8 to 14 m along the dividing
/// wall, 6 to 10 m across it (more if the object needs it), the doors anywhere in the wall, start
/// and goal up to 1.5 m beside the near door's axis, one or two of `options.movable` in the door
/// (the same one twice, too), and the doors as wide as these and the object need and up to 0.4 m
/// wider. Size, depth, doors and play of the options are ignored.
DividedRoomOptions drawDividedRoom(const Catalog& catalog, DividedRoomOptions options);

}  // namespace casepush
