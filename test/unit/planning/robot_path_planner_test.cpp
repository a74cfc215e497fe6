#include "casepush/planning/robot_path_planner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>

#include "casepush/common/input_error.h"
#include "casepush/model/catalog.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

RobotModel cobot() { return Catalog::standard().robot("cobot"); }
ObjectModel chair() { return Catalog::standard().object("office_chair"); }

WorldModel emptyRoom(double size_m) {
  Random random(1);
  return randomRoom(&random, size_m, 0);
}

Pose2 straight(const Pose2& from, const Pose2& to, double t) {
  const Eigen::Vector2d p = from.position() + t * (to.position() - from.position());
  return {p.x(), p.y(), from.yaw() + t * yawDifference(from, to)};
}

/// Deepest overlap of the true shape at steps of 1 cm, all waypoints included.
double deepestOverlap(const RobotPath& path, const CollisionChecker& checker,
                      const Footprint& footprint) {
  double deepest = 0.0;
  for (std::size_t i = 1; i < path.waypoints.size(); ++i) {
    const Pose2& from = path.waypoints[i - 1];
    const Pose2& to = path.waypoints[i];
    const int steps = 1 + static_cast<int>(distance(from, to) / 0.01);
    for (int k = 0; k <= steps; ++k) {
      const Pose2 pose = straight(from, to, static_cast<double>(k) / steps);
      for (const auto& contact : checker.contacts(footprint, pose)) {
        deepest = std::max(deepest, contact.depth_m);
      }
    }
  }
  return deepest;
}

void expectEnds(const RobotPath& path, const Pose2& start, const Pose2& goal) {
  ASSERT_GE(path.waypoints.size(), 2U);
  const auto expectSame = [](const Pose2& a, const Pose2& b) {
    EXPECT_EQ(a.x(), b.x());
    EXPECT_EQ(a.y(), b.y());
    EXPECT_EQ(a.yaw(), b.yaw());
  };
  expectSame(path.waypoints.front(), start);
  expectSame(path.waypoints.back(), goal);
  EXPECT_GE(path.length_m, distance(start, goal) - 1e-9);
}

/// Free cells for the robot as a stack of discs with margin, by brute force over occupied cells.
std::vector<bool> freeCells(const CollisionChecker::Columns& columns, const RobotModel& robot,
                            double margin_m) {
  std::vector<bool> free(columns.bits.size(), true);
  const auto slices = [&](const HeightRange& range) {
    std::uint64_t mask = 0;
    for (int bit = 0; bit < 64; ++bit) {
      const double low = bit * columns.slice_m;
      if (low < range.high_m - 1e-6 && low + columns.slice_m > range.low_m + 1e-6) {
        mask |= std::uint64_t{1} << bit;
      }
    }
    return mask;
  };
  for (const auto& part : robot.solid) {
    const double radius = circumscribedRadius({part}) + margin_m;
    const std::uint64_t mask = slices(heightRange(part));
    const int reach = static_cast<int>(std::ceil(radius / columns.resolution_m)) + 1;
    for (int cell = 0; cell < columns.width * columns.height; ++cell) {
      const int cx = cell % columns.width;
      const int cy = cell / columns.width;
      const bool near_border =
          (std::min({cx, cy, columns.width - 1 - cx, columns.height - 1 - cy}) + 0.5) *
              columns.resolution_m <
          radius;
      if (near_border) free[cell] = false;
      if ((columns.bits[cell] & mask) == 0) continue;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const int x = cx + dx;
          const int y = cy + dy;
          if (x < 0 || y < 0 || x >= columns.width || y >= columns.height) continue;
          const double gap =
              std::hypot(std::max(0.0, std::abs(dx) - 0.5), std::max(0.0, std::abs(dy) - 0.5));
          if (gap * columns.resolution_m < radius) free[y * columns.width + x] = false;
        }
      }
    }
  }
  return free;
}

std::vector<int> components(const std::vector<bool>& free, int width) {
  std::vector<int> label(free.size(), 0);
  const int height = static_cast<int>(free.size()) / width;
  int count = 0;
  for (std::size_t seed = 0; seed < free.size(); ++seed) {
    if (!free[seed] || label[seed] != 0) continue;
    std::vector<int> open{static_cast<int>(seed)};
    label[seed] = ++count;
    while (!open.empty()) {
      const int cell = open.back();
      open.pop_back();
      for (int k = 0; k < 9; ++k) {
        const int x = cell % width + k % 3 - 1;
        const int y = cell / width + k / 3 - 1;
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        if (!free[y * width + x] || label[y * width + x] != 0) continue;
        label[y * width + x] = count;
        open.push_back(y * width + x);
      }
    }
  }
  return label;
}

TEST(RobotPathPlannerTest, findsAPathExactlyIfTheFloodFillDoes) {
  Random random(21);
  const RobotModel robot = cobot();
  const RobotPathOptions options;
  const RobotPathPlanner planner(robot, options);
  int found = 0;
  int separated = 0;
  for (int room = 0; room < 12; ++room) {
    const Map map = mapOf(randomRoom(&random, 5.0, 16), 0.05);
    const CollisionChecker checker(map);
    const auto footprint = checker.footprint(robot.solid);
    const auto& columns = checker.columns();
    const auto free = freeCells(columns, robot, options.margin_m);
    // Ends that are clear wherever in their cells: nothing to undock from, no need to dock.
    const auto clear = freeCells(columns, robot, options.margin_m + 0.036);
    const auto label = components(free, columns.width);
    const auto cellOf = [&](const Pose2& pose) {
      const Eigen::Vector2d at = (pose.position() - columns.origin_m) / columns.resolution_m;
      return static_cast<int>(at.y()) * columns.width + static_cast<int>(at.x());
    };
    for (int i = 0; i < 150; ++i) {
      const Pose2 start = randomPose(&random, 0.3, 4.7);
      const Pose2 goal = randomPose(&random, 0.3, 4.7);
      if (!clear[cellOf(start)] || !clear[cellOf(goal)] || distance(start, goal) < 0.6) continue;
      const bool connected = label[cellOf(start)] == label[cellOf(goal)];
      const RobotPath path = planner.plan(checker, start, goal, goal.yaw());
      ASSERT_EQ(path.found, connected) << path.explanation << " room " << room << " query " << i;
      if (connected) {
        ++found;
        expectEnds(path, start, goal);
        EXPECT_EQ(deepestOverlap(path, checker, *footprint), 0.0);
      } else {
        ++separated;
        EXPECT_NE(path.explanation.find("no free path from"), std::string::npos);
      }
    }
  }
  EXPECT_GT(found, 60);
  EXPECT_GT(separated, 10);
}

/// Distance at which the robot, beyond the chair along `angle`, just touches it, plus a gap.
Pose2 besideChair(const CollisionChecker& checker, const Footprint& robot, const Pose2& map_T_chair,
                  double angle_rad, double gap_m) {
  double out = 1.0;
  const auto at = [&](double d) {
    return Pose2(map_T_chair.x() + d * std::cos(angle_rad),
                 map_T_chair.y() + d * std::sin(angle_rad), wrapAngle(angle_rad + M_PI));
  };
  while (!checker.collides(robot, at(out))) out -= 0.001;
  return at(out + 0.001 + gap_m);
}

TEST(RobotPathPlannerTest, leavesContactAndGoesAroundToTheOtherSide) {
  const RobotModel robot = cobot();
  const RobotPathPlanner planner(robot, {});
  CollisionChecker checker(mapOf(emptyRoom(6.0), 0.05));
  const auto footprint = checker.footprint(robot.solid);
  Random random(31);
  for (int i = 0; i < 60; ++i) {
    const Pose2 map_T_chair = randomPose(&random, 2.2, 3.8);
    checker.setObstacles({{chair().solid, map_T_chair, "chair_1"}});
    const double angle = random.uniform(-M_PI, M_PI);
    // After a push the estimate may have the robot up to a centimetre inside.
    const double start_gap = random.uniform(-0.01, 0.005);
    const Pose2 start = besideChair(checker, *footprint, map_T_chair, angle, start_gap);
    const double goal_gap = random.uniform(0.0, 0.03);
    const Pose2 goal = besideChair(checker, *footprint, map_T_chair,
                                   angle + M_PI + random.uniform(-0.5, 0.5), goal_gap);
    const RobotPath path = planner.plan(checker, start, goal, goal.yaw());
    ASSERT_TRUE(path.found) << path.explanation;
    expectEnds(path, start, goal);
    EXPECT_GE(path.length_m, 1.0);
    double at_start = 0.0;
    for (const auto& contact : checker.contacts(*footprint, start)) at_start = contact.depth_m;
    EXPECT_LE(deepestOverlap(path, checker, *footprint), at_start + 2e-6);
    // The last motion is the dock: straight along the direction, heading fixed.
    const Pose2& pre_dock = path.waypoints[path.waypoints.size() - 2];
    EXPECT_EQ(pre_dock.yaw(), goal.yaw());
    const Eigen::Vector2d dock = goal.position() - pre_dock.position();
    EXPECT_GT(dock.norm(), 0.01);
    EXPECT_NEAR(wrapAngle(std::atan2(dock.y(), dock.x()) - goal.yaw()), 0.0, 1e-6);
    EXPECT_EQ(path.waypoints[1].yaw(), start.yaw()) << "it turned before it was clear";
  }
}

TEST(RobotPathPlannerTest, staysCollisionFreeAmongChairsInFurnishedRooms) {
  Random random(41);
  const RobotModel robot = cobot();
  const RobotPathPlanner planner(robot, {});
  int found = 0;
  for (int room = 0; room < 8; ++room) {
    CollisionChecker checker(mapOf(randomRoom(&random, 7.0, 10), 0.05));
    std::vector<PlacedSolid> chairs;
    const auto chair_footprint = checker.footprint(chair().solid);
    while (chairs.size() < 3) {
      const Pose2 pose = randomPose(&random, 1.0, 6.0);
      if (!checker.collides(*chair_footprint, pose)) chairs.push_back({chair().solid, pose, "c"});
    }
    checker.setObstacles(chairs);
    const auto footprint = checker.footprint(robot.solid);
    for (int i = 0; i < 40; ++i) {
      const Pose2 start = randomPose(&random, 0.5, 6.5);
      const Pose2 goal = randomPose(&random, 0.5, 6.5);
      const RobotPath path = planner.plan(checker, start, goal, random.uniform(-M_PI, M_PI));
      if (checker.collides(*footprint, start) || !path.found) continue;
      ++found;
      expectEnds(path, start, goal);
      EXPECT_LE(deepestOverlap(path, checker, *footprint), 0.01 + 2e-6) << "more than tolerated";
      if (!checker.collides(*footprint, goal)) {
        EXPECT_EQ(deepestOverlap(path, checker, *footprint), 0.0);
      }
    }
  }
  EXPECT_GT(found, 60);
}

TEST(RobotPathPlannerTest, drivesUnderWhatIsHighEnough) {
  WorldModel world = emptyRoom(4.0);
  // A beam across the room, above the robot or not.
  const double top_m = heightRange(cobot().solid).high_m;
  for (const bool high : {true, false}) {
    WorldModel with_beam = world;
    const double low_m = high ? top_m + 0.06 : top_m - 0.1;
    with_beam.boxes.push_back({"beam", {{0.1, 3.9, 0.3}}, placed(2.0, 2.0, low_m + 0.15)});
    const CollisionChecker checker(mapOf(with_beam, 0.05));
    const RobotPath path = RobotPathPlanner(cobot(), {}).plan(checker, {1, 2, 0}, {3, 2, 0}, 0);
    EXPECT_EQ(path.found, high) << path.explanation;
    EXPECT_NEAR(path.length_m, high ? 2.0 : 0.0, 0.05);
  }
}

TEST(RobotPathPlannerTest, keepsAwayFromCornersWhereThereIsRoom) {
  WorldModel world = emptyRoom(6.0);
  world.boxes.push_back({"wall", {{0.1, 3.5, 1.0}}, placed(3.0, 1.75, 0.5)});
  const CollisionChecker checker(mapOf(world, 0.05));
  const RobotPath path = RobotPathPlanner(cobot(), {}).plan(checker, {2, 1, 0}, {4, 1, 1}, 1.0);
  ASSERT_TRUE(path.found);
  const auto wide = checker.footprint(cobot().solid, 0.12);
  EXPECT_EQ(deepestOverlap(path, checker, *wide), 0.0);
  EXPECT_LT(path.waypoints.size(), 12U);
  EXPECT_LT(path.length_m, 7.5);
}

std::string explanation(const CollisionChecker& checker, const Pose2& start, const Pose2& goal,
                        double direction_rad) {
  const RobotPath path = RobotPathPlanner(cobot(), {}).plan(checker, start, goal, direction_rad);
  EXPECT_FALSE(path.found);
  EXPECT_TRUE(path.waypoints.empty());
  return path.explanation;
}

TEST(RobotPathPlannerTest, saysWhyThereIsNoPath) {
  CollisionChecker checker(mapOf(emptyRoom(6.0), 0.05));
  const Solid block{{Box{{1.0, 1.0, 1.0}}, placed(0, 0, 0.5), "body"}};
  checker.setObstacles({{block, {3, 3, 0}, "block_1"}});
  EXPECT_EQ(explanation(checker, {1, 1, 0}, {3.1, 3, 0}, 0), "dock pose blocked by block_1 (body)");
  EXPECT_NE(
      explanation(checker, {1, 1, 0}, {0.1, 3, 0}, 0).find("dock pose blocked by the map near"),
      std::string::npos);
  EXPECT_EQ(explanation(checker, {1, 1, 0}, {9, 3, 0}, 0),
            "dock pose blocked by the outside of the map");
  EXPECT_EQ(explanation(checker, {1, 1, 0}, {std::nan(""), 3, 0}, 0),
            "dock pose or direction is not finite");
  EXPECT_EQ(explanation(checker, {1, INFINITY, 0}, {1, 3, 0}, 0), "start pose is not finite");
  // The robot touches the block's left side, but the push would come from inside the block.
  EXPECT_EQ(explanation(checker, {1, 1, 0}, {2.21, 3, M_PI}, M_PI),
            "no room to dock: the straight way to the dock pose is blocked by block_1 (body)");
}

TEST(RobotPathPlannerTest, saysWhenItIsShutIn) {
  CollisionChecker checker(mapOf(emptyRoom(6.0), 0.05));
  const auto fence = [](double half_m) {
    Solid solid;
    for (int side = 0; side < 4; ++side) {
      const double angle = side * M_PI / 2;
      solid.push_back({Box{{0.1, 2 * half_m + 0.1, 1.0}},
                       placed(half_m * std::cos(angle), half_m * std::sin(angle), 0.5, angle),
                       "rail"});
    }
    return solid;
  };
  checker.setObstacles({{fence(0.8), {2, 2, 0}, "fence"}});
  EXPECT_EQ(explanation(checker, {2, 2, 0}, {4, 4, 0}, 0),
            "no free path from (2.00, 2.00) to the dock pose (4.00, 4.00)");
  checker.setObstacles({{fence(0.34), {2, 2, 0}, "fence"}});
  EXPECT_EQ(explanation(checker, {2, 2, 0}, {4, 4, 0}, 0),
            "start pose blocked by fence (rail): there is no straight way out");
}

TEST(RobotPathPlannerTest, goesStraightToAGoalThatItStandsBefore) {
  CollisionChecker checker(mapOf(emptyRoom(6.0), 0.05));
  const auto footprint = checker.footprint(cobot().solid);
  checker.setObstacles({{chair().solid, {3, 3, 0.3}, "chair_1"}});
  const Pose2 goal = besideChair(checker, *footprint, {3, 3, 0.3}, 2.0, 0.02);
  const Pose2 start = goal * Pose2(-0.06, 0.01, 0.1);
  const RobotPath path = RobotPathPlanner(cobot(), {}).plan(checker, start, goal, goal.yaw());
  ASSERT_TRUE(path.found);
  EXPECT_EQ(path.waypoints.size(), 2U);
  const RobotPath stay = RobotPathPlanner(cobot(), {}).plan(checker, start, start, goal.yaw());
  ASSERT_TRUE(stay.found);
  EXPECT_EQ(stay.length_m, 0.0);
  EXPECT_EQ(stay.waypoints.size(), 2U);
}

TEST(RobotPathPlannerTest, refusesOptionsAndRobotsThatMakeNoSense) {
  RobotPathOptions options;
  options.margin_m = -0.1;
  try {
    RobotPathPlanner(cobot(), options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "robot path: margin_m: is -0.1, must be in [0, 1]");
  }
  RobotModel nothing;
  nothing.name = "ghost";
  EXPECT_THROW(RobotPathPlanner(nothing, {}), InputError);
}

TEST(RobotPathPlannerTest, isDeterministicAndFastInTheOffice) {
  const WorldModel office = Catalog::standard().world("office");
  CollisionChecker checker(mapOf(office, 0.05));
  checker.setObstacles({{chair().solid, office.objects.front().map_T_object, "chair_1"}});
  const RobotModel robot = cobot();
  const RobotPathPlanner planner(robot, {});
  const auto footprint = checker.footprint(robot.solid);
  Random random(51);
  std::vector<double> times_ms;
  for (int i = 0; i < 100; ++i) {
    const Pose2 start = randomPose(&random, 0.5, 14.5);
    const Pose2 goal = randomPose(&random, 0.5, 14.5);
    const std::clock_t begin = std::clock();
    const RobotPath path = planner.plan(checker, start, goal, goal.yaw());
    const double time_ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (!path.found) continue;
    if (times_ms.size() < 20) {
      const RobotPath again = RobotPathPlanner(robot, {}).plan(checker, start, goal, goal.yaw());
      ASSERT_EQ(again.waypoints.size(), path.waypoints.size());
      for (std::size_t k = 0; k < path.waypoints.size(); ++k) {
        EXPECT_EQ(distance(again.waypoints[k], path.waypoints[k]), 0.0);
      }
    }
    times_ms.push_back(time_ms);
  }
  ASSERT_GT(times_ms.size(), 30U);
  std::sort(times_ms.begin(), times_ms.end());
  std::cout << times_ms.size() << " paths, median " << times_ms[times_ms.size() / 2]
            << " ms, worst " << times_ms.back() << " ms\n";
}

}  // namespace
}  // namespace casepush
