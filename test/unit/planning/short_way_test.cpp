#include "planning/short_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "casepush/model/catalog.h"
#include "planning/straight_motion.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

class ShortWayTest : public ::testing::Test {
 protected:
  ShortWayTest() : checker_(mapOf(emptyRoom(), 0.05)) {
    checker_.setObstacles({{Catalog::standard().object("office_chair").solid, chair_, "chair_1"}});
    docking_ = checker_.footprint(robot_.solid, 0.01);
    plain_ = checker_.footprint(robot_.solid);
  }

  static WorldModel emptyRoom() {
    Random random(1);
    return randomRoom(&random, 6.0, 0);
  }

  /// The robot looks at the chair from `bearing_rad`, `gap_m` from touching it.
  Pose2 beside(double bearing_rad, double gap_m) const {
    const auto at = [&](double r) {
      return Pose2(chair_.x() + r * std::cos(bearing_rad), chair_.y() + r * std::sin(bearing_rad),
                   bearing_rad + M_PI);
    };
    double r = 1.0;
    while (!checker_.collides(*plain_, at(r))) r -= 0.001;
    return at(r + 0.001 + gap_m);
  }

  double depth(const Footprint& footprint, const Pose2& pose) const {
    double deepest = 0.0;
    for (const Contact& contact : checker_.contacts(footprint, pose)) {
      deepest = std::max(deepest, contact.depth_m);
    }
    return deepest;
  }

  const RobotModel robot_ = Catalog::standard().robot("cobot");
  const Pose2 chair_{3.0, 3.0, 0.3};
  CollisionChecker checker_;
  std::shared_ptr<const Footprint> docking_;
  std::shared_ptr<const Footprint> plain_;
};

TEST_F(ShortWayTest, leavesTheObjectsSideBeforeItTurnsAndDocksStraight) {
  Random random(2);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const double bearing_rad = random.uniform(-M_PI, M_PI);
    const Pose2 start =
        beside(bearing_rad, random.uniform(0.0, 0.01)) * Pose2(0.0, 0.0, random.uniform(-0.8, 0.8));
    const Pose2 goal = beside(bearing_rad + random.uniform(-0.5, 0.5), 0.03);
    const std::vector<Pose2> way = shortWay(checker_, *docking_, start, goal, goal.yaw());
    if (way.empty()) continue;
    ++found;
    EXPECT_EQ(distance(way.front(), start), 0.0);
    EXPECT_EQ(distance(way.back(), goal), 0.0);
    const double touching_m = depth(*docking_, start);
    for (int k = 0; k <= 50; ++k) {
      const Pose2 pose = between(way[0], way[1], k / 50.0);
      const double most_m = k <= 16 ? touching_m : depth(*docking_, goal);
      EXPECT_LE(depth(*docking_, pose), most_m + 1e-3) << "push " << i << ", " << k / 50.0;
    }
    if (way.size() == 2) continue;
    const Pose2 along = way[1].inverse() * goal;
    EXPECT_GT(along.x(), 0.029);
    EXPECT_NEAR(along.y(), 0.0, 1e-9);
    EXPECT_NEAR(along.yaw(), 0.0, 1e-9);
  }
  EXPECT_GT(found, 100);
}

TEST_F(ShortWayTest, doesNotGoThroughTheObject) {
  for (double bearing_rad = -3.0; bearing_rad < 3.0; bearing_rad += 0.5) {
    const Pose2 start = beside(bearing_rad, 0.01);
    const Pose2 goal = beside(bearing_rad + M_PI, 0.03);
    EXPECT_TRUE(shortWay(checker_, *docking_, start, goal, goal.yaw()).empty());
  }
}

TEST_F(ShortWayTest, docksAtOnceFromWhereItStandsBeforeTheGoal) {
  const Pose2 goal = beside(2.0, 0.02);
  EXPECT_EQ(shortWay(checker_, *docking_, goal * Pose2(-0.06, 0.01, 0.1), goal, goal.yaw()).size(),
            2U);
  EXPECT_EQ(shortWay(checker_, *docking_, goal * Pose2(-0.06, 0.01, 0.5), goal, goal.yaw()).size(),
            3U);
  EXPECT_EQ(shortWay(checker_, *docking_, goal, goal, goal.yaw()).size(), 2U);
}

}  // namespace
}  // namespace casepush
