#include "../../../src/execution/tube_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/random.h"

namespace casepush {
namespace {

// Two seconds at 0.25 m/s along x; the scatter grows on the way to (2 cm, 0.1 rad).
Case straightCase(double count) {
  Case straight;
  straight.push_steps = 21;
  for (int i = 0; i <= 20; ++i) {
    const Pose2 start_T_object(0.025 * i, 0.0, 0.0);
    const double share = 0.2 + 0.8 * i / 20.0;
    straight.steps.push_back({Pose2(-0.6, 0.0, 0.0), Twist2{0.25, 0.0, 0.0}, start_T_object});
    straight.tube.push_back(
        {start_T_object,
         Eigen::Matrix3d((share * Eigen::Vector3d(0.02, 0.02, 0.1)).cwiseAbs2().asDiagonal())});
  }
  straight.start_outcome = straight.tube.back();
  straight.effective_count = count;
  return straight;
}

TubeWatchOptions watching() {
  TubeWatchOptions options;
  options.on = true;
  return options;
}

// When the watch says that an object on `course` has left, in push time; nothing if never.
template <typename Course>
std::optional<double> leftAt(const Case& push_case, const Course& course) {
  TubeWatch watch(push_case, watching());
  for (int i = 0; i <= 100; ++i) {
    const double t_s = 0.02 * i;
    if (watch.hasLeft(t_s, 100.0 + t_s, course(t_s))) {
      return t_s;
    }
  }
  return std::nullopt;
}

TEST(TubeWatch, letsPushesPassThatScatterAsTheCaseSays) {
  const Case push_case = straightCase(20);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d off(random.normal(0.02), random.normal(0.02), random.normal(0.1));
    const double late_s = random.uniform(-0.2, 0.2);
    const auto left = leftAt(push_case, [&](double t_s) {
      const double share = std::clamp((t_s - late_s) / 2.0, 0.0, 1.0);
      return Pose2(0.5 * share, 0.0, 0.0) * expSe2(share * off);
    });
    EXPECT_FALSE(left) << "push " << i << " broken off at " << *left << " s";
  }
}

TEST(TubeWatch, noticesWithinTenthsOfASecondThatTheObjectStandsStill) {
  const auto left = leftAt(straightCase(20), [](double) { return Pose2(); });
  ASSERT_TRUE(left);
  // 6 cm take 0.24 s, 0.3 s are slack and 0.1 s it must last.
  EXPECT_GT(*left, 0.5);
  EXPECT_LT(*left, 1.0);
}

TEST(TubeWatch, noticesThatTheObjectTurnsAway) {
  const auto left = leftAt(straightCase(20), [](double t_s) {
    return Pose2(0.25 * std::min(t_s, 1.0), 0.0, 1.5 * std::max(0.0, t_s - 1.0));
  });
  ASSERT_TRUE(left);
  EXPECT_GT(*left, 1.0);
  EXPECT_LT(*left, 1.7);
}

TEST(TubeWatch, isPatientWithACaseThatWasTriedOnce) {
  const auto off = [](double t_s) { return Pose2(0.25 * t_s, 0.075 * t_s, 0.0); };
  EXPECT_TRUE(leftAt(straightCase(20), off));
  EXPECT_FALSE(leftAt(straightCase(1), off));
}

TEST(TubeWatch, countsAPoseThatIsSeenOnceOnlyOnce) {
  TubeWatch watch(straightCase(20), watching());
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(watch.hasLeft(1.5, 101.5, Pose2(0.0, 1.0, 0.0)));
  }
  EXPECT_TRUE(watch.hasLeft(1.62, 101.62, Pose2(0.0, 1.0, 0.0)));
  EXPECT_LT(watch.pValue(), 1e-4);
  EXPECT_NE(watch.describe().find(" cm and 0 deg off its course"), std::string::npos)
      << watch.describe();
}

TEST(TubeWatch, makesATubeOfTheOutcomeIfTheCaseHasNone) {
  Case bare = straightCase(20);
  bare.tube.clear();
  EXPECT_TRUE(leftAt(bare, [](double) { return Pose2(); }));
  EXPECT_FALSE(leftAt(bare, [](double t_s) { return Pose2(0.25 * t_s, 0.0, 0.0); }));
}

}  // namespace
}  // namespace casepush
