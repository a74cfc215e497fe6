#include "casepush/execution/displacement_coverage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace casepush {
namespace {

TEST(ToleranceDistance, isOneWhereATaskJustSucceeds) {
  EXPECT_DOUBLE_EQ(toleranceDistance(Pose2(), Pose2(0.2, 0.0, 0.0)), 1.0);
  EXPECT_NEAR(toleranceDistance(Pose2(0, 0, 3.1), Pose2(0, 0, 3.1 + M_PI / 9)), 1.0, 1e-9);
}

TEST(DisplacementCoverage, gainIsWhatAddingBrings) {
  DisplacementCoverage coverage;
  const Pose2 ahead(0.5, 0.0, 0.4);
  const double before = coverage.meanDistance();
  const double gain = coverage.gain(ahead);
  EXPECT_GT(gain, 0.0);
  coverage.add(ahead);
  EXPECT_NEAR(coverage.meanDistance(), before - gain, 1e-12);
  EXPECT_DOUBLE_EQ(coverage.gain(ahead), 0.0);
  // The other side is worth more now than the neighbourhood.
  EXPECT_GT(coverage.gain(Pose2(-0.5, 0.0, -0.4)), 3.0 * coverage.gain(Pose2(0.55, 0.0, 0.4)));
}

TEST(DisplacementCoverage, standingStillIsWorthNothing) {
  EXPECT_DOUBLE_EQ(DisplacementCoverage().gain(Pose2()), 0.0);
}

TEST(ReachableShare, growsWithPushesAndKnowsWhatStaysOutOfReach) {
  std::vector<Pose2> displacements;
  for (int i = 0; i < 6; ++i) {
    for (const double turn : {-0.7, 0.0, 0.7}) {
      displacements.emplace_back(0.4 * std::cos(i * M_PI / 3), 0.4 * std::sin(i * M_PI / 3), turn);
    }
  }
  const double one = reachableShare(displacements, 1, 0.8);
  const double two = reachableShare(displacements, 2, 0.8);
  const double three = reachableShare(displacements, 3, 0.8);
  EXPECT_LT(one, two);
  EXPECT_LT(two, three);
  EXPECT_LE(three, 1.0);
  // Without turning pushes only headings near the first one are reached: 2 pi / 9 of 2 pi.
  std::vector<Pose2> straight;
  for (int i = 0; i < 12; ++i) {
    straight.emplace_back(0.3 * std::cos(i * M_PI / 6), 0.3 * std::sin(i * M_PI / 6), 0.0);
  }
  EXPECT_LE(reachableShare(straight, 3, 0.8), 1.0 / 9.0 + 0.01);
}

}  // namespace
}  // namespace casepush
