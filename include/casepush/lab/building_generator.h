#pragma once

#include <cstdint>
#include <string>

#include "casepush/model/catalog.h"

namespace casepush {

struct BuildingOptions {
  std::uint64_t seed = 1;
  double size_m = 50.0;   ///< Edge length of the square building, outer walls included.
  double room_m = 10.0;   ///< Edge length of its rooms, about.
  double door_m = 1.8;    ///< Width of doors, one between any two neighbouring rooms.
  double density = 0.06;  ///< Share of the floor under furniture.
  std::string object = "office_chair";
  std::string robot = "cobot";
  void validate() const;  ///< @throws InputError listing every violation.
};

/// A square building of furnished rooms with doors between neighbours. The object starts in the
/// first room, its goal is in the last one, the opposite corner. From the middle of each room ways
/// to its doors are free of furniture. Same options, same building. @throws InputError from the
/// catalog.
WorldModel generateBuilding(const Catalog& catalog, const BuildingOptions& options);

}  // namespace casepush
