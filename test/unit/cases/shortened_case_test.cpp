#include "casepush/cases/shortened_case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace casepush {
namespace {

/// A straight push at 0.3 m/s with ramps of three steps; the object coasts 6 cm more.
Case straightPush() {
  Case made;
  made.id = 7;
  made.object = "chair";
  made.robot = "robot";
  made.period_s = 0.1;
  made.push_steps = 26;
  double x_m = 0.0;
  for (int i = 0; i < 30; ++i) {
    const double height = std::min({1.0, i / 3.0, (25 - i) / 3.0});
    CaseStep step;
    step.object_T_robot = Pose2(-0.6 - (i > 26 ? 0.01 : 0.0), 0.0, 0.0);
    step.action = i < 26 ? Twist2{0.3 * height, 0.0, 0.0} : Twist2{};
    step.start_T_object = Pose2(x_m, 0.0, 0.0);
    made.steps.push_back(step);
    x_m += i < 26 ? 0.03 * std::max(0.0, height) : 0.02;
  }
  made.start_outcome.mean = made.steps.back().start_T_object;
  made.start_outcome.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-3).asDiagonal();
  made.effective_count = 5;
  made.observation_count = 5;
  return made;
}

TEST(ShortenedCase, LeavesOutFullSpeedAndKeepsBothRampsAndTheCoasting) {
  const Case whole = straightPush();
  const auto shorter = shortenedCase(whole, 0.0);
  ASSERT_TRUE(shorter);
  const int left_out = whole.push_steps - shorter->push_steps;
  EXPECT_EQ(left_out, 19);
  EXPECT_EQ(whole.steps.size() - shorter->steps.size(), 19U);
  EXPECT_NEAR(shorter->start_outcome.mean.x(), whole.start_outcome.mean.x() - 19 * 0.03, 1e-9);
  EXPECT_EQ(shorter->start_outcome.covariance, whole.start_outcome.covariance);
  EXPECT_NEAR(shorter->steps.back().start_T_object.x(), shorter->start_outcome.mean.x(), 1e-9);
  EXPECT_EQ(shorter->source_id, 7);
  for (std::size_t i = 1; i < shorter->steps.size(); ++i) {
    const double step_m =
        shorter->steps[i].start_T_object.x() - shorter->steps[i - 1].start_T_object.x();
    EXPECT_GE(step_m, -1e-9);
    EXPECT_LE(step_m, 0.031);
  }
}

TEST(ShortenedCase, KeepsTheShareAskedFor) {
  const auto half = shortenedCase(straightPush(), 0.5);
  ASSERT_TRUE(half);
  EXPECT_NEAR(straightPush().push_steps - half->push_steps, 0.5 * 19, 1.0);
}

TEST(ShortenedCase, FollowsTheMeanTrajectoryIfItIsKnown) {
  Case whole = straightPush();
  for (const CaseStep& step : whole.steps) {
    const Pose2& pose = step.start_T_object;
    whole.tube.push_back({Pose2(1.1 * pose.x(), 0.0, 0.0), whole.start_outcome.covariance});
  }
  whole.start_outcome.mean = whole.tube.back().mean;
  const auto shorter = shortenedCase(whole, 0.0);
  ASSERT_TRUE(shorter);
  EXPECT_EQ(shorter->tube.size(), shorter->steps.size());
  EXPECT_NEAR(shorter->tube.back().mean.x(), shorter->start_outcome.mean.x(), 1e-9);
  EXPECT_NEAR(shorter->start_outcome.mean.x(), whole.start_outcome.mean.x() - 1.1 * 19 * 0.03,
              1e-9);
}

TEST(ShortenedCase, IsNotMadeWhereTheRobotMovedAlongTheObject) {
  Case slid = straightPush();
  for (int i = 0; i < slid.push_steps; ++i) {
    slid.steps[i].object_T_robot = Pose2(-0.6, 0.004 * i, 0.0);
  }
  EXPECT_FALSE(shortenedCase(slid, 0.0));
  EXPECT_TRUE(shortenedCase(slid, 0.8)) << "in the little left out it did not";
}

TEST(WithShortened, GivesEachItsOwnNegativeIdAfterTheWholeOnes) {
  Case other = straightPush();
  other.id = 8;
  const std::vector<Case> all = withShortened({straightPush(), other});
  ASSERT_EQ(all.size(), 6U);
  std::set<std::int64_t> ids;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(isShortened(all[i]), i >= 2);
    EXPECT_TRUE(ids.insert(all[i].id).second);
    EXPECT_NO_THROW(validateCase(all[i], "case"));
  }
}

TEST(WithShortened, LeavesManyCasesAndShortenedOnesAlone) {
  const std::vector<Case> all = withShortened({straightPush()});
  EXPECT_EQ(withShortened(all).size(), all.size());
  EXPECT_EQ(withShortened(std::vector<Case>(501, straightPush())).size(), 501U);
}

}  // namespace
}  // namespace casepush
