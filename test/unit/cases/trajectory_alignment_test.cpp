#include "casepush/cases/trajectory_alignment.h"

#include <algorithm>
#include <limits>

#include "case_fixtures.h"

namespace casepush {
namespace {

double squared(const Pose2& a, const Pose2& b, double yaw_scale_m) {
  const double yaw_m = yaw_scale_m * yawDifference(a, b);
  return (a.position() - b.position()).squaredNorm() + yaw_m * yaw_m;
}

// The oracle: tries every monotone matching of what is left from (i, k) on.
double leastCost(const std::vector<Pose2>& a, const std::vector<Pose2>& b, std::size_t i,
                 std::size_t k, double yaw_scale_m) {
  const double here = squared(a[i], b[k], yaw_scale_m);
  if (i + 1 == a.size() && k + 1 == b.size()) {
    return here;
  }
  double rest = std::numeric_limits<double>::infinity();
  if (i + 1 < a.size()) rest = leastCost(a, b, i + 1, k, yaw_scale_m);
  if (k + 1 < b.size()) rest = std::min(rest, leastCost(a, b, i, k + 1, yaw_scale_m));
  if (i + 1 < a.size() && k + 1 < b.size()) {
    rest = std::min(rest, leastCost(a, b, i + 1, k + 1, yaw_scale_m));
  }
  return here + rest;
}

std::vector<Pose2> randomTrajectory(Random& random, std::size_t count) {
  std::vector<Pose2> trajectory;
  for (std::size_t i = 0; i < count; ++i) {
    trajectory.push_back(randomPose(random, 0.5, 2.0));
  }
  return trajectory;
}

// An arc that turns through +-pi, at a share of its way.
Pose2 arcAt(double share) { return Pose2(0.2, 0.1, 2.6) * expSe2({0.8 * share, 0.0, 1.2 * share}); }

TEST(AlignTrajectories, findsTheLeastCostOfAllMatchings) {
  Random random(1);
  for (int run = 0; run < 300; ++run) {
    const auto a = randomTrajectory(random, 1 + random.below(6));
    const auto b = randomTrajectory(random, 1 + random.below(6));
    const double yaw_scale_m = random.uniform(0.0, 1.0);
    const TrajectoryAlignment alignment = alignTrajectories(a, b, yaw_scale_m);
    EXPECT_NEAR(alignment.cost, leastCost(a, b, 0, 0, yaw_scale_m), 1e-12);
    ASSERT_EQ(alignment.places.size(), a.size());
    EXPECT_TRUE(std::is_sorted(alignment.places.begin(), alignment.places.end()));
    EXPECT_EQ(alignment.places.front(), a.size() > 1 ? 0.0 : b.size() - 1.0);
    EXPECT_EQ(alignment.places.back(), b.size() - 1.0);
  }
}

TEST(AlignTrajectories, matchesATrajectoryWithItself) {
  Random random(2);
  const auto trajectory = randomTrajectory(random, 40);
  const TrajectoryAlignment alignment = alignTrajectories(trajectory, trajectory);
  EXPECT_EQ(alignment.cost, 0.0);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(alignment.places[i], static_cast<double>(i));
  }
}

TEST(AlignTrajectories, takesTheMiddleOfAStop) {
  const std::vector<Pose2> reference{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  const std::vector<Pose2> stops{
      {0.0, 0.0, 0.0}, {0.9, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.1, 0.0, 0.0}, {2.0, 0.0, 0.0}};
  const std::vector<double> places = alignTrajectories(reference, stops).places;
  EXPECT_EQ(places, (std::vector<double>{0.0, 2.0, 4.0}));
}

TEST(AlignTrajectories, undoesAnotherTimingAcrossPi) {
  std::vector<Pose2> reference;
  std::vector<Pose2> warped;
  constexpr int kSteps = 40;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    reference.push_back(arcAt(share));
    warped.push_back(arcAt(share * share));  // Slow at first, twice as fast in the end.
  }
  const std::vector<Pose2> aligned = posesAt(warped, alignTrajectories(reference, warped).places);
  double largest_m = 0.0;
  double largest_unaligned_m = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    largest_m = std::max(largest_m, distance(aligned[i], reference[i]));
    largest_unaligned_m = std::max(largest_unaligned_m, distance(warped[i], reference[i]));
    EXPECT_LT(std::abs(yawDifference(aligned[i], reference[i])), 0.05);
  }
  EXPECT_GT(largest_unaligned_m, 0.15);
  EXPECT_LT(largest_m, 0.025) << "one spacing of the samples is 0.02 m, at the end 0.04 m";
}

TEST(PosesAt, interpolatesOnTheGroup) {
  const std::vector<Pose2> trajectory{{0.0, 0.0, 3.0}, {0.2, 0.0, -3.0}, {0.4, 0.0, -3.0}};
  const std::vector<Pose2> poses = posesAt(trajectory, {0.0, 0.5, 1.0, 2.0});
  expectSamePose(poses[0], trajectory[0]);
  EXPECT_NEAR(std::abs(poses[1].yaw()), M_PI, 1e-12);
  expectSamePose(poses[2], trajectory[1]);
  expectSamePose(poses[3], trajectory[2]);
}

TEST(TravelledShares, measureTheWay) {
  const std::vector<double> shares = travelledShares({{0, 0, 0}, {0.1, 0, 0}, {0.4, 0, 0}});
  EXPECT_NEAR(shares[1], 0.25, 1e-12);
  EXPECT_EQ(shares[2], 1.0);
  EXPECT_EQ(travelledShares({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}),
            (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(travelledShares({{1, 1, 1}}), std::vector<double>{0.0});
}

}  // namespace
}  // namespace casepush
