#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "casepush/model/catalog.h"

namespace casepush {

struct CollisionBenchmarkOptions {
  std::string object = "overbed_table";
  std::string robot = "cobot";
  int tests = 1000000;  ///< Over all rooms.
  int rooms = 10;       ///< 15 x 15 m, each with 34 to 45 boxes of random sizes, tilts and heights.
  int motions = 14;     ///< Pushes to choose from in each room.
  double resolution_m = 0.05;
  std::uint64_t seed = 1;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// One way of testing a push: object along its path and at its sigma points, robot along its path.
struct CollisionBackend {
  std::string name;
  double tests_per_s = 0.0;  ///< By the thread's CPU time.
  int missed = 0;            ///< Collisions by FCL that it does not see.
  int extra = 0;             ///< Collisions that it sees and FCL does not.
};

struct CollisionBenchmark {
  std::vector<CollisionBackend> backends;  ///< The first one is FCL on the OctoMap.
  int tests = 0;
  int collisions = 0;    ///< By FCL.
  int contacts = 0;      ///< Where growing or shrinking the shapes by 0.1 mm decides; they
                         ///< count as neither missed nor extra.
  double mask_ms = 0.0;  ///< To make the masks of one motion at all headings.
  double map_ms = 0.0;   ///< To take a map's octree over into columns and images.
};

/// Random motions at random places, tested by each back-end.
///
/// 20 poses of the object, 6 around its end and 20 of the robot; every back-end gets the same tests
/// in the same order. Without FCL its figures and all comparisons are 0.
/// @param progress  Called now and then with the number of tests that FCL has answered.
/// @throws InputError from the catalog or validate().
CollisionBenchmark measureCollisionChecking(const Catalog& catalog,
                                            const CollisionBenchmarkOptions& options,
                                            const std::function<void(int)>& progress = {});

}  // namespace casepush
