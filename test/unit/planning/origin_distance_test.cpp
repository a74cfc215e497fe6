#include "planning/origin_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "world/random_scene.h"

namespace casepush {
namespace {

Solid disc(double radius_m) { return {{Cylinder{radius_m, 0.5}, placed(0.0, 0.0, 0.35), "disc"}}; }

WorldModel roomWithWall(double gap_m) {
  Random random(1);
  WorldModel world = randomRoom(&random, 6.0, 0);
  // From the lower wall up to the gap below the upper one.
  const double length_m = 5.9 - gap_m;
  world.boxes.push_back({"wall", {{0.1, length_m, 1.0}}, placed(3.0, length_m / 2.0, 0.5)});
  return world;
}

class OriginDistanceTest : public testing::Test {
 protected:
  static OriginDistance distanceIn(const WorldModel& world, double radius_m,
                                   const Eigen::Vector2d& goal_m,
                                   const std::function<bool()>& stop = {}) {
    const CollisionChecker checker(mapOf(world, 0.05));
    return {checker.columns(), disc(radius_m), goal_m, 0.2, stop ? Patience(stop) : Patience()};
  }
};

TEST_F(OriginDistanceTest, isAtMostTheStraightWayInTheOpenAndNotMuchLess) {
  Random random(2);
  const WorldModel world = randomRoom(&random, 6.0, 0);
  const OriginDistance distance = distanceIn(world, 0.3, {3.0, 3.0});
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d from(random.uniform(0.6, 5.4), random.uniform(0.6, 5.4));
    const double way_m = std::max(0.0, (from - Eigen::Vector2d(3.0, 3.0)).norm() - 0.2);
    EXPECT_LE(distance.at(from), way_m + 1e-9);
    EXPECT_GE(distance.at(from), 0.92 * way_m - 0.25);
  }
}

TEST_F(OriginDistanceTest, goesAroundAWall) {
  const OriginDistance distance = distanceIn(roomWithWall(1.5), 0.3, {5.0, 1.0});
  const double around_m = 2.0 * std::hypot(2.0, 3.4);
  EXPECT_GT(distance.at({1.0, 1.0}), 0.85 * around_m);
  EXPECT_LT(distance.at({1.0, 1.0}), 1.05 * around_m);
}

TEST_F(OriginDistanceTest, isInfiniteWhereNoGapIsWideEnough) {
  EXPECT_TRUE(std::isfinite(distanceIn(roomWithWall(0.9), 0.3, {5.0, 1.0}).at({1.0, 1.0})));
  EXPECT_FALSE(std::isfinite(distanceIn(roomWithWall(0.3), 0.3, {5.0, 1.0}).at({1.0, 1.0})));
  EXPECT_TRUE(std::isfinite(distanceIn(roomWithWall(0.3), 0.1, {5.0, 1.0}).at({1.0, 1.0})));
}

TEST_F(OriginDistanceTest, knowsNothingOnceItWasStopped) {
  int asked = 0;
  const auto stop = [&asked] { return ++asked > 0; };
  const WorldModel world = [] {
    Random random(1);
    return randomRoom(&random, 15.0, 0);
  }();
  EXPECT_EQ(distanceIn(world, 0.3, {14.0, 14.0}, stop).at({1.0, 1.0}), 0.0);
  EXPECT_EQ(asked, 1);
}

}  // namespace
}  // namespace casepush
