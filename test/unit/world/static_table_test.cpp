#include "casepush/world/static_table.h"

#include <gtest/gtest.h>

#include <limits>

#include "casepush/common/input_error.h"
#include "world/random_motion.h"

namespace casepush {
namespace {

constexpr double kLength_m = 6.3;
constexpr double kWidth_m = 4.0;

/// A room that is longer than wide, so that turned images differ in size.
Map oblongMap(Random* random, double resolution_m) {
  WorldModel world = randomRoom(random, kWidth_m, 3);
  world.max_m.x() = kLength_m;
  return mapOf(world, resolution_m);
}

/// A map, and some pushes on it.
struct Scene {
  Scene(std::uint64_t seed, double resolution_m, int motions, double reach_m = 4.0)
      : random(seed), checker(oblongMap(&random, resolution_m)) {
    const auto object = checker.footprint(leaningSolid(), 0.02);
    const auto robot = checker.footprint(roundRobot());
    const auto classes = SweepChecker::heightClasses(checker, {object, robot});
    sweeps = std::make_unique<SweepChecker>(checker, classes, reach_m);
    for (int i = 0; i < motions; ++i) {
      const RandomMotion motion = randomMotion(&random, 12);
      own.push_back(std::make_unique<Sweep>(tracksOf(motion, object, robot), classes));
      prepared.push_back(own.back().get());
    }
  }

  Pose2 randomStart() {
    const Pose2 pose = randomPose(&random, 0.001, kLength_m - 0.001);
    return {pose.x(), pose.y() * kWidth_m / kLength_m, pose.yaw()};
  }

  Random random;
  CollisionChecker checker;
  std::unique_ptr<SweepChecker> sweeps;
  std::vector<std::unique_ptr<Sweep>> own;
  std::vector<const Sweep*> prepared;
};

bool isSet(const StaticTable& table, const Pose2& start, int sweep) {
  return (table.blocked(start, sweep / 64) >> sweep % 64 & 1) != 0;
}

class StaticTableTest : public testing::TestWithParam<double> {};

TEST_P(StaticTableTest, saysWhatTheMasksSay) {
  constexpr int kSweeps = 11;
  Scene scene(3, GetParam(), kSweeps);
  const StaticTable table(*scene.sweeps, scene.prepared);
  int blocked = 0;
  int collisions = 0;
  constexpr int kStarts = 3000;
  for (int i = 0; i < kStarts; ++i) {
    const Pose2 start = scene.randomStart();
    for (int s = 0; s < kSweeps; ++s) {
      const bool may = scene.sweeps->mayCollide(*scene.prepared[s], start);
      ASSERT_EQ(isSet(table, start, s), may)
          << s << ": " << start.x() << " " << start.y() << " " << start.yaw();
      blocked += may;
      collisions += scene.sweeps->collides(*scene.prepared[s], start);
    }
    ASSERT_EQ(table.blocked(start) ^ table.free(start), (std::uint64_t{1} << kSweeps) - 1);
  }
  EXPECT_GT(collisions, kStarts);
  EXPECT_LT(blocked, kStarts * kSweeps * 19 / 20);
}

INSTANTIATE_TEST_SUITE_P(Resolutions, StaticTableTest, testing::Values(0.03, 0.05, 0.1));

TEST(StaticTableTest, goesOnInMoreWords) {
  constexpr int kSweeps = 130;
  Scene scene(4, 0.2, kSweeps);
  const StaticTable table(*scene.sweeps, scene.prepared);
  ASSERT_EQ(table.words(), 3);
  int blocked = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose2 start = scene.randomStart();
    for (int s = 0; s < kSweeps; ++s) {
      ASSERT_EQ(isSet(table, start, s), scene.sweeps->mayCollide(*scene.prepared[s], start)) << s;
      blocked += isSet(table, start, s);
    }
    EXPECT_EQ(table.blocked(start, 2) | table.free(start, 2), 3U);
  }
  EXPECT_LT(blocked, 100 * kSweeps);
}

TEST(StaticTableTest, takesTheMapWithoutObstacles) {
  Scene scene(5, 0.1, 3);
  const StaticTable table(*scene.sweeps, scene.prepared);
  scene.checker.setObstacles({{leaningSolid(), Pose2(kLength_m / 2.0, kWidth_m / 2.0, 0.0)}});
  const StaticTable with_obstacle(scene.sweeps->withObstaclesOf(scene.checker), scene.prepared);
  for (int i = 0; i < 1000; ++i) {
    const Pose2 start = scene.randomStart();
    ASSERT_EQ(table.blocked(start), with_obstacle.blocked(start));
  }
}

TEST(StaticTableTest, blocksWhatItCannotKnow) {
  Scene scene(6, 0.2, 9);
  const StaticTable table(*scene.sweeps, scene.prepared);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const Pose2& start : {Pose2(-0.3, 1.0, 0.0), Pose2(1.0, kWidth_m + 0.3, 0.0),
                             Pose2(kNan, 1.0, 0.0), Pose2(1.0, 1.0, kNan)}) {
    EXPECT_EQ(table.blocked(start), 0x1ffU);
    EXPECT_EQ(table.free(start), 0U);
  }
}

TEST(StaticTableTest, refusesWhatItHasNoMemoryFor) {
  Scene scene(7, 0.2, 9);
  const StaticTable table(*scene.sweeps, scene.prepared);
  EXPECT_NO_THROW(StaticTable(*scene.sweeps, scene.prepared, table.bytes()));
  try {
    StaticTable(*scene.sweeps, scene.prepared, table.bytes() - 1);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("static table: 9 sweeps"), std::string::npos)
        << error.what();
  }
}

TEST(StaticTableTest, refusesSweepsBeyondTheCheckersReach) {
  const Scene scene(8, 0.2, 2, 0.5);
  EXPECT_THROW(StaticTable(*scene.sweeps, scene.prepared), InputError);
}

}  // namespace
}  // namespace casepush
