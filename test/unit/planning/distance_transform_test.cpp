#include "planning/distance_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "casepush/common/random.h"
#include "planning/clearance_grid.h"

namespace casepush {
namespace {

TEST(DistanceToSquaresTest, agreesWithBruteForce) {
  Random random(4);
  for (int round = 0; round < 60; ++round) {
    const int width = 1 + static_cast<int>(random.below(40));
    const int height = 1 + static_cast<int>(random.below(40));
    const double density = random.chance(0.5) ? 0.01 : 0.2;
    std::vector<std::uint8_t> occupied(width * height);
    for (auto& cell : occupied) cell = random.chance(density);
    occupied[random.below(occupied.size())] = 1;
    const auto result = distanceToSquares(occupied, width, height);
    for (int cell = 0; cell < width * height; ++cell) {
      double expected = 1e9;
      for (int other = 0; other < width * height; ++other) {
        if (!occupied[other]) continue;
        const double dx = std::max(0.0, std::abs(cell % width - other % width) - 0.5);
        const double dy = std::max(0.0, std::abs(cell / width - other / width) - 0.5);
        expected = std::min(expected, std::hypot(dx, dy));
      }
      ASSERT_NEAR(result[cell], expected, 1e-4) << width << "x" << height << " cell " << cell;
    }
  }
}

TEST(DistanceToSquaresTest, isHugeWithoutOccupiedCells) {
  for (const float distance : distanceToSquares(std::vector<std::uint8_t>(12, 0), 4, 3)) {
    EXPECT_GT(distance, 1e5F);
  }
  EXPECT_TRUE(distanceToSquares({}, 0, 0).empty());
}

TEST(TravelDiscsTest, haveTheWidestPartOfEachHeight) {
  const auto at = [](double x, double z) {
    return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, z));
  };
  const Solid solid{{Cylinder{0.25, 0.3}, at(0, 0.15), "base"},
                    {Cylinder{0.1, 1.0}, at(0.05, 0.5), "mast"},
                    {Box{{0.6, 0.8, 0.2}}, at(0, 0.7), "tray"}};
  const auto discs = travelDiscs(solid, 0.01);
  ASSERT_EQ(discs.size(), 4U);
  const double expected[][3] = {
      {0.0, 0.3, 0.26}, {0.3, 0.6, 0.16}, {0.6, 0.8, 0.51}, {0.8, 1.0, 0.16}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(discs[i].low_m, expected[i][0], 1e-12);
    EXPECT_NEAR(discs[i].high_m, expected[i][1], 1e-12);
    EXPECT_NEAR(discs[i].radius_m, expected[i][2], 1e-12);
  }
}

/// Grid of the given size with some occupied columns, for a thin robot.
CollisionChecker::Columns randomColumns(Random* random, int width, int height) {
  CollisionChecker::Columns columns;
  columns.origin_m = {-1.0, 0.5};
  columns.resolution_m = columns.slice_m = 0.05;
  columns.width = width;
  columns.height = height;
  columns.bits.resize(width * height);
  for (auto& bits : columns.bits) bits = random->chance(0.02) ? 0b100 : 0;
  return columns;
}

TEST(ClearanceGridTest, lineSeesEveryCellThatItPasses) {
  Random random(8);
  const auto columns = randomColumns(&random, 50, 40);
  const ClearanceGrid grid(columns, {{0.1, 0.15, 0.02}});
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector2d from(random.uniform(-1.0, 1.5), random.uniform(0.5, 2.5));
    Eigen::Vector2d to(random.uniform(-1.0, 1.5), random.uniform(0.5, 2.5));
    if (i % 3 == 0) to.x() = from.x();
    float sampled = 1e9F;
    for (int k = 0; k <= 3000; ++k) {
      sampled = std::min(sampled, grid.clearance(grid.cell(from + k / 3000.0 * (to - from))));
    }
    const float seen = grid.clearanceAlong(from, to);
    EXPECT_LE(seen, sampled);
    EXPECT_GE(seen, sampled - 0.08F) << "one cell farther at most, cut between two samples";
  }
  EXPECT_LT(grid.clearanceAlong({0.0, 1.0}, {0.0, 3.0}), -1e9F);
}

TEST(ClearanceGridTest, isTheSameAsMadeAnewAfterAChange) {
  Random random(10);
  const std::vector<TravelDisc> discs = {{0.1, 0.15, 0.2}, {0.1, 0.3, 0.05}};
  CollisionChecker::Columns columns = randomColumns(&random, 150, 130);
  for (auto& bits : columns.bits) bits = random.chance(0.002) ? 0b100 : 0;
  ClearanceGrid grid(columns, discs);
  for (int round = 0; round < 30; ++round) {
    const CellBox box = columns.cellsIn(
        {{random.uniform(-1.5, 6.0), random.uniform(0.0, 6.5)}, {6.5, random.uniform(0.5, 7.5)}});
    for (int y = box.y0; y <= box.y1; ++y) {
      for (int x = box.x0; x <= box.x1; ++x) {
        columns.bits[y * columns.width + x] = random.chance(0.002) ? 0b100 : 0;
      }
    }
    const Eigen::Vector2d low = columns.origin_m + 0.05 * Eigen::Vector2d(box.x0, box.y0);
    const Eigen::Vector2d high = columns.origin_m + 0.05 * Eigen::Vector2d(box.x1 + 1, box.y1 + 1);
    grid = grid.updated(columns, discs, {low, high});
    const ClearanceGrid anew(columns, discs);
    for (int cell = 0; cell < anew.size(); ++cell) {
      ASSERT_EQ(grid.clearance(cell), anew.clearance(cell)) << round << ": " << cell;
    }
  }
}

TEST(ClearanceGridTest, solidsLowerTheClearanceExactly) {
  Random random(9);
  auto columns = randomColumns(&random, 60, 60);
  std::fill(columns.bits.begin(), columns.bits.end(), 0);
  ClearanceGrid grid(columns, {{0.1, 0.5, 0.1}});
  const ClearanceGrid before = grid;
  const Solid post{
      {Cylinder{0.2, 1.0}, Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.6)), "p"}};
  grid.add({post, {0.5, 2.0, M_PI / 2}}, {{0.1, 0.5, 0.1}}, 0.3);
  int changed = 0;
  for (int cell = 0; cell < grid.size(); ++cell) {
    const double expected = (grid.centre(cell) - Eigen::Vector2d(0.5, 2.1)).norm() - 0.3;
    const double least = std::min<double>(before.clearance(cell), expected);
    EXPECT_GE(grid.clearance(cell), least - 1e-5);
    if (expected < 0.3) {
      EXPECT_LE(grid.clearance(cell), least + 1e-5);
    }
    changed += grid.clearance(cell) < before.clearance(cell);
  }
  EXPECT_GT(changed, 100);
}

}  // namespace
}  // namespace casepush
