#include "planning/goal_guide.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "casepush/common/random.h"
#include "planning/furnished_room.h"

namespace casepush {
namespace {

const Eigen::Vector2d kStart(4.0, 7.0);
const Eigen::Vector2d kGoal(11.0, 7.0);
constexpr double kTolerance_m = 0.2;

WorldModel roomWithWall(double length_m) {
  WorldModel world = emptyRoom();
  world.boxes.push_back(standing("wall", 7.5, 0.5 * length_m, 0.2, length_m, 1.5));
  return world;
}

/// A guide and what it needs.
struct Guided {
  explicit Guided(const ObjectRoom& room, const std::vector<PlacedSolid>& obstacles = {})
      : half_steps(room.halfSteps(obstacles)),
        guide(room, half_steps, kStart, kGoal, kTolerance_m) {}

  double at(const Eigen::Vector2d& point_m) { return guide.at(point_m); }
  bool reachesStart() const { return guide.reachesStart(); }

  std::vector<HalfSteps> half_steps;
  GoalGuide guide;
};

TEST(GoalGuide, isAboutTheStraightWayInTheOpen) {
  const CollisionChecker checker(*mapOf(emptyRoom()));
  const ObjectRoom room(checker.columns(), testChair().solid);
  Guided guide(room);
  EXPECT_TRUE(guide.reachesStart());
  EXPECT_NEAR(guide.at(kStart), 7.0, 0.4);
  EXPECT_LT(guide.at(kGoal), 0.3);
}

TEST(GoalGuide, leadsAroundWallsAndObjects) {
  const CollisionChecker checker(*mapOf(roomWithWall(11.0)));
  const ObjectRoom room(checker.columns(), testChair().solid);
  const double around_m = Guided(room).at(kStart);
  EXPECT_GT(around_m, 10.0);
  // Chairs at the near side of the gap make the way longer.
  Guided narrow(room, {{testChair().solid, Pose2(7.5, 11.8, 0.0)},
                       {testChair().solid, Pose2(7.5, 12.8, 0.0)}});
  EXPECT_TRUE(narrow.reachesStart());
  EXPECT_GT(narrow.at(kStart), around_m + 0.3);
}

// It goes on only as far as somebody asks.
TEST(GoalGuide, answersTheSameInAnyOrder) {
  const CollisionChecker checker(*mapOf(furnishedRoom()));
  const ObjectRoom room(checker.columns(), testChair().solid);
  Random random(3);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 400; ++i) {
    points.emplace_back(random.uniform(-1.0, 16.0), random.uniform(-1.0, 16.0));
  }
  Guided forwards(room);
  std::vector<double> ways_m;
  for (const Eigen::Vector2d& point : points) ways_m.push_back(forwards.at(point));
  Guided backwards(room);
  for (std::size_t i = points.size(); i-- > 0;) {
    EXPECT_EQ(backwards.at(points[i]), ways_m[i]) << points[i].transpose();
  }
  EXPECT_GT(*std::max_element(ways_m.begin(), ways_m.end()), 10.0);
}

TEST(GoalGuide, boundsTheWaysWithoutGoingOn) {
  const CollisionChecker checker(*mapOf(furnishedRoom()));
  const ObjectRoom room(checker.columns(), testChair().solid);
  const std::vector<PlacedSolid> chairs = {{testChair().solid, Pose2(7.5, 7.2, 0.3)},
                                           {testChair().solid, Pose2(6.5, 6.4, 1.0)}};
  Guided asked(room, chairs);
  Guided all(room, chairs);
  Random random(5);
  int rough = 0;
  double lacking_m = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d point(random.uniform(-1.0, 16.0), random.uniform(-1.0, 16.0));
    const GoalGuide::Way way = asked.guide.atLeast(point);
    const double exact_m = all.at(point);
    rough += way.is_exact ? 0 : 1;
    lacking_m += exact_m - way.length_m;
    EXPECT_LE(way.length_m, exact_m + 2e-3) << point.transpose();
    if (way.is_exact || i % 40 == 39) {
      EXPECT_EQ(asked.at(point), exact_m) << point.transpose();
    }
  }
  EXPECT_GT(rough, 50);
  EXPECT_LT(lacking_m / 400, 0.5);
}

TEST(GoalGuide, seesThatThereIsNoWay) {
  const CollisionChecker checker(*mapOf(roomWithWall(15.0)));
  const ObjectRoom room(checker.columns(), testChair().solid);
  EXPECT_FALSE(Guided(room).reachesStart());
}

}  // namespace
}  // namespace casepush
