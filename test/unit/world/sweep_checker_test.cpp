#include "casepush/world/sweep_checker.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "world/random_motion.h"

namespace casepush {
namespace {

struct Setting {
  double resolution_m;
  double object_margin_m;
  bool obstacles;
};

class SweepCheckerTest : public testing::TestWithParam<Setting> {};

std::vector<PlacedSolid> someObstacles(Random* random) {
  std::vector<PlacedSolid> obstacles;
  for (int i = 0; i < 2; ++i) {
    obstacles.push_back({leaningSolid(), randomPose(random, 1.0, 6.0)});
  }
  return obstacles;
}

TEST_P(SweepCheckerTest, saysTheSameAsTestingEveryPose) {
  Random random(11);
  int hits = 0;
  int may_hit = 0;
  int tested = 0;
  for (int scene = 0; scene < 4; ++scene) {
    CollisionChecker checker(mapOf(randomRoom(&random, 7.0, 6), GetParam().resolution_m));
    const auto object = checker.footprint(leaningSolid(), GetParam().object_margin_m);
    const auto robot = checker.footprint(roundRobot(), 0.03);
    const auto classes = SweepChecker::heightClasses(checker, {object, robot});
    SweepChecker sweeps(checker, classes, 4.0);
    if (GetParam().obstacles) {
      checker.setObstacles(someObstacles(&random));
      sweeps = sweeps.withObstaclesOf(checker);
    }
    for (int m = 0; m < 4; ++m) {
      const Sweep sweep(tracksOf(randomMotion(&random, 30), object, robot), classes);
      for (int i = 0; i < 200; ++i) {
        const Pose2 start = randomPose(&random, -0.2, 7.2);
        const bool expected = sweeps.collidesPoseByPose(sweep, start);
        ASSERT_EQ(sweeps.collides(sweep, start), expected)
            << start.x() << " " << start.y() << " " << start.yaw();
        const bool may = sweeps.mayCollide(sweep, start);
        ASSERT_TRUE(may || !expected) << start.x() << " " << start.y() << " " << start.yaw();
        hits += expected;
        may_hit += may;
        ++tested;
      }
    }
  }
  EXPECT_GT(hits, tested / 10);
  EXPECT_LT(hits, tested - tested / 8);
  EXPECT_LT(may_hit - hits, tested / 4);
}

INSTANTIATE_TEST_SUITE_P(Settings, SweepCheckerTest,
                         testing::Values(Setting{0.05, 0.0, false}, Setting{0.05, 0.05, true},
                                         Setting{0.02, 0.0, true}, Setting{0.1, 0.03, false},
                                         Setting{0.2, 0.0, true}));

/// One box in a room, and the chair-sized cylinder pushed along x past it.
class SweepPastABox : public testing::Test {
 protected:
  SweepPastABox() {
    WorldModel world = emptyWorld();
    world.boxes.push_back({"box", {{0.4, 0.4, 0.4}}, placed(3.0, 2.0, 0.2)});
    map_ = std::make_unique<Map>(mapOf(world, 0.05));
    checker_ = std::make_unique<CollisionChecker>(*map_);
  }

  static WorldModel emptyWorld() {
    Random random(1);
    return randomRoom(&random, 5.0, 0);
  }

  static Solid disc(double low_m, double high_m) {
    return {{Cylinder{0.3, high_m - low_m}, placed(0.0, 0.0, (low_m + high_m) / 2.0), "disc"}};
  }

  bool collides(const Solid& solid, const Pose2& start) const {
    const auto body = checker_->footprint(solid);
    const auto classes = SweepChecker::heightClasses(*checker_, {body});
    const SweepChecker sweeps(*checker_, classes, 3.0);
    std::vector<Pose2> path;
    for (int i = 0; i <= 50; ++i) path.emplace_back(0.04 * i, 0.0, 0.0);
    return sweeps.collides(Sweep({{body, path}}, classes), start);
  }

  std::unique_ptr<Map> map_;
  std::unique_ptr<CollisionChecker> checker_;
};

TEST_F(SweepPastABox, seesTheBoxInTheWayAndNotBesideIt) {
  EXPECT_TRUE(collides(disc(0.1, 0.9), {1.5, 2.0, 0.0}));
  EXPECT_TRUE(collides(disc(0.1, 0.9), {1.5, 2.49, 0.0}));
  EXPECT_FALSE(collides(disc(0.1, 0.9), {1.5, 2.51, 0.0}));
  EXPECT_TRUE(collides(disc(0.1, 0.9), {3.0, 0.8, M_PI / 2}));
  EXPECT_FALSE(collides(disc(0.1, 0.9), {3.6, 0.8, M_PI / 2}));
}

TEST_F(SweepPastABox, passesOverWhatIsLower) {
  EXPECT_FALSE(collides(disc(0.45, 0.9), {1.5, 2.0, 0.0}));
  EXPECT_TRUE(collides(disc(0.35, 0.9), {1.5, 2.0, 0.0}));
}

TEST_F(SweepPastABox, mayNotLeaveTheMap) {
  EXPECT_TRUE(collides(disc(2.0, 2.5), {3.0, 1.0, 0.0}));
  EXPECT_FALSE(collides(disc(2.0, 2.5), {2.69, 1.0, 0.0}));
  EXPECT_TRUE(collides(disc(2.0, 2.5), {-3.0, 1.0, 0.0}));
  EXPECT_TRUE(collides(disc(2.0, 2.5), {std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0}));
}

TEST_F(SweepPastABox, motionsBeyondTheImagesAreTestedPoseByPose) {
  const auto body = checker_->footprint(disc(0.1, 0.9));
  const auto classes = SweepChecker::heightClasses(*checker_, {body});
  const SweepChecker sweeps(*checker_, classes, 1.0);
  std::vector<Pose2> path;
  for (int i = 0; i <= 400; ++i) path.emplace_back(0.04 * i, 0.0, 0.0);
  const Sweep far(std::vector<Track>{{body, path}}, classes);
  EXPECT_TRUE(sweeps.collides(far, {0.5, 1.0, 0.0}));
  EXPECT_TRUE(sweeps.mayCollide(far, {0.5, 1.0, 0.0}));
}

TEST_F(SweepPastABox, masksMadeByManyThreadsAreTheSame) {
  const auto body = checker_->footprint(disc(0.1, 0.9));
  const auto classes = SweepChecker::heightClasses(*checker_, {body});
  const SweepChecker sweeps(*checker_, classes, 3.0);
  const Sweep sweep(std::vector<Track>{{body, {{0.0, 0.0, 0.0}, {0.5, 0.1, 0.4}}}}, classes);
  std::vector<std::vector<bool>> answers(4);
  std::vector<std::thread> threads;
  for (auto& own : answers) {
    threads.emplace_back([&] {
      Random random(5);
      for (int i = 0; i < 500; ++i) {
        own.push_back(sweeps.collides(sweep, randomPose(&random, 0.0, 5.0)));
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& own : answers) EXPECT_EQ(own, answers.front());
}

}  // namespace
}  // namespace casepush
