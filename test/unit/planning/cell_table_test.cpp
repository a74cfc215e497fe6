#include "planning/cell_table.h"

#include <gtest/gtest.h>

#include <unordered_map>

#include "casepush/common/random.h"
#include "planning/pose_cell.h"

namespace casepush {
namespace {

std::uint64_t randomCell(Random* random) {
  // Some lie side by side, some far apart.
  const double x = random->uniform(-3.0, 3.0) + (random->chance(0.3) ? 500.0 : 0.0);
  const double y = random->uniform(-3.0, 3.0);
  return poseCell(Pose2(x, y, random->uniform(-3.1, 3.1)), 0.2, 0.3);
}

TEST(CellTable, holdsWhatAMapWouldHold) {
  Random random(3);
  CellTable table;
  std::unordered_map<std::uint64_t, int> expected;
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t cell = randomCell(&random);
    if (expected.count(cell) == 0) {
      ASSERT_EQ(table.find(cell), nullptr);
      table.add({cell, static_cast<float>(i), i});
      expected[cell] = i;
    } else if (random.chance(0.4)) {
      table.erase(cell);
      expected.erase(cell);
    } else {
      table.find(cell)->node = i;
      expected[cell] = i;
    }
  }
  ASSERT_GT(expected.size(), 2000U);
  for (const auto& [cell, node] : expected) {
    ASSERT_NE(table.find(cell), nullptr);
    EXPECT_EQ(table.find(cell)->node, node);
  }
  table.clear();
  EXPECT_EQ(table.find(expected.begin()->first), nullptr);
}

TEST(PoseCell, changesByOneFromCellToCell) {
  const std::uint64_t here = poseCell(Pose2(-1.0, 2.0, -0.5), 0.1, 0.3);
  EXPECT_EQ(poseCell(Pose2(-0.96, 2.04, -0.5), 0.1, 0.3), here);
  EXPECT_EQ(poseCell(Pose2(-0.9, 2.0, -0.5), 0.1, 0.3), here + (std::uint64_t{1} << 42));
  EXPECT_EQ(poseCell(Pose2(-1.0, 1.9, -0.5), 0.1, 0.3), here - (std::uint64_t{1} << 21));
  EXPECT_EQ(poseCell(Pose2(-1.0, 2.0, -0.5 - 0.1 / 0.3), 0.1, 0.3), here - 1);
}

}  // namespace
}  // namespace casepush
