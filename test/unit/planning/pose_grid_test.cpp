#include "casepush/planning/pose_grid.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr double kPi = 3.14159265358979323846;

Pose2 randomPose(Random* random, double low, double high) {
  const double x = random->uniform(low, high);
  const double y = random->uniform(low, high);
  return Pose2(x, y, random->uniform(-kPi, kPi));
}

int nearestByBruteForce(const std::vector<Pose2>& poses, const std::vector<bool>& present,
                        const Pose2& query, double rho_m) {
  int best = -1;
  for (int i = 0; i < static_cast<int>(poses.size()); ++i) {
    if (present[i] && (best < 0 || squaredPoseDistance(poses[i], query, rho_m) <
                                       squaredPoseDistance(poses[best], query, rho_m))) {
      best = i;
    }
  }
  return best;
}

TEST(SquaredPoseDistance, wrapsTheYaw) {
  EXPECT_NEAR(squaredPoseDistance(Pose2(0, 0, kPi - 0.1), Pose2(0, 0, -kPi + 0.1), 0.5), 0.01,
              1e-12);
  EXPECT_NEAR(squaredPoseDistance(Pose2(1, 2, 0.3), Pose2(4, 6, 0.3), 0.5), 25.0, 1e-12);
}

struct GridCase {
  double rho_m;
  double bucket_m;
  int poses;
};

class PoseGridQueries : public testing::TestWithParam<GridCase> {};

TEST_P(PoseGridQueries, nearestIsThatOfBruteForceWhilePosesComeAndGo) {
  const GridCase& parameters = GetParam();
  Random random(11);
  PoseGrid grid({0, 0}, {10, 8}, parameters.rho_m, parameters.bucket_m);
  std::vector<Pose2> poses;
  std::vector<bool> present;
  for (int i = 0; i < parameters.poses; ++i) {
    poses.push_back(randomPose(&random, -2.0, 12.0));  // Some lie outside of the bounds.
    present.push_back(true);
    grid.insert(i, poses.back());
    if (random.chance(0.4)) {
      const int gone = static_cast<int>(random.below(poses.size()));
      if (present[gone]) {
        grid.remove(gone, poses[gone]);
        present[gone] = false;
      }
    }
    const Pose2 query = randomPose(&random, -3.0, 13.0);
    ASSERT_EQ(grid.nearest(query), nearestByBruteForce(poses, present, query, parameters.rho_m));
  }
  EXPECT_EQ(grid.size(), std::count(present.begin(), present.end(), true));
}

TEST_P(PoseGridQueries, withinFindsEachPoseOnce) {
  const GridCase& parameters = GetParam();
  Random random(12);
  PoseGrid grid({0, 0}, {10, 8}, parameters.rho_m, parameters.bucket_m);
  std::vector<Pose2> poses;
  for (int i = 0; i < parameters.poses; ++i) {
    poses.push_back(randomPose(&random, -1.0, 11.0));
    grid.insert(i, poses.back());
  }
  for (int k = 0; k < 50; ++k) {
    const Pose2 query = randomPose(&random, -1.0, 11.0);
    const double radius_m = random.uniform(0.0, 4.0);
    std::vector<int> expected;
    for (int i = 0; i < parameters.poses; ++i) {
      if (squaredPoseDistance(poses[i], query, parameters.rho_m) <= radius_m * radius_m) {
        expected.push_back(i);
      }
    }
    std::vector<int> found;
    grid.within(query, radius_m, &found);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, PoseGridQueries,
                         testing::Values(GridCase{0.3, 0.4, 600}, GridCase{0.05, 0.4, 300},
                                         GridCase{1.5, 0.25, 300}, GridCase{0.7, 20.0, 100},
                                         GridCase{0.3, 0.3, 3}));

TEST(PoseGrid, givesTheLowestIdOfEquallyNearPoses) {
  PoseGrid grid({0, 0}, {5, 5}, 0.3, 0.4);
  grid.insert(7, Pose2(3, 2, 0));
  grid.insert(4, Pose2(1, 2, 0));
  EXPECT_EQ(grid.nearest(Pose2(2, 2, 0)), 4);
}

TEST(PoseGrid, hasNoNearestWhenEmpty) {
  PoseGrid grid({0, 0}, {5, 5}, 0.3, 0.4);
  EXPECT_EQ(grid.nearest(Pose2()), -1);
  grid.insert(1, Pose2(1, 1, 1));
  grid.clear();
  EXPECT_TRUE(grid.empty());
  EXPECT_EQ(grid.nearest(Pose2()), -1);
}

}  // namespace
}  // namespace casepush
