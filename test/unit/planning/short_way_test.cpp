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
    travelling_ = checker_.footprint(robot_.solid, 0.04);
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

  std::vector<Pose2> way(const Pose2& start, const Pose2& goal) const {
    return shortWay(checker_, *docking_, *travelling_, start, goal, goal.yaw());
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
  std::shared_ptr<const Footprint> travelling_;
  std::shared_ptr<const Footprint> plain_;
};

TEST_F(ShortWayTest, leavesTheObjectsSideBeforeItTurnsAndDocksStraight) {
  Random random(2);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const double bearing_rad = random.uniform(-M_PI, M_PI);
    const Pose2 start =
        beside(bearing_rad, random.uniform(0.0, 0.01)) * Pose2(0.0, 0.0, random.uniform(-0.8, 0.8));
    const double gap_m = random.uniform(-0.005, 0.03);  // The goal may touch it.
    const Pose2 goal = beside(bearing_rad + random.uniform(-0.5, 0.5), gap_m);
    const std::vector<Pose2> poses = way(start, goal);
    if (poses.size() != 3) continue;
    ++found;
    EXPECT_EQ(distance(poses.front(), start), 0.0);
    EXPECT_EQ(distance(poses.back(), goal), 0.0);
    const double touching_m = depth(*docking_, start);
    const Footprint& fast = distance(poses[0], poses[1]) < 0.2 ? *docking_ : *travelling_;
    for (int k = 0; k <= 50; ++k) {
      const Pose2 pose = between(poses[0], poses[1], k / 50.0);
      EXPECT_LE(k <= 16 ? depth(*docking_, pose) - touching_m : depth(fast, pose), 1e-3)
          << "push " << i << ", " << k / 50.0;
    }
    const Pose2 along = poses[1].inverse() * goal;
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
    EXPECT_TRUE(way(start, goal).empty());
  }
}

TEST_F(ShortWayTest, docksAtOnceFromWhereItStandsBeforeTheGoal) {
  const Pose2 goal = beside(2.0, 0.02);
  EXPECT_EQ(way(goal * Pose2(-0.06, 0.01, 0.1), goal).size(), 2U);
  EXPECT_EQ(way(goal * Pose2(-0.06, 0.01, 0.5), goal).size(), 3U);
  EXPECT_EQ(way(goal, goal).size(), 2U);
}

}  // namespace
}  // namespace casepush
