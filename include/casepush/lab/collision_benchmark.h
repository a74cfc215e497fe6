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
  bool static_table = false;  ///< Measure a StaticTable of all pushes as well.
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

/// A StaticTable asked for all pushes at a start at once, as for all cases at a node of a search.
struct StaticTableCost {
  double build_s = 0.0;  ///< For one room, all masks included; by the thread's CPU time.
  double memory_mb = 0.0;
  double mask_tests_per_s = 0.0;  ///< The masks, asked for the same, one push after the other.
  /// Tests on one map for which the masks take as long as the table with its making; 0: never.
  double pays_from_tests = 0.0;
};

struct CollisionBenchmark {
  /// The first one is FCL on the OctoMap. With a static table it is the last one; its tests_per_s
  /// count every push at every start.
  std::vector<CollisionBackend> backends;
  StaticTableCost static_table;
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
