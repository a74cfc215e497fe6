#include "casepush/planning/push_time.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/random.h"
#include "planning/synthetic_pushes.h"

namespace casepush {
namespace {

std::vector<PreparedCase> prepare(const std::vector<Case>& cases) {
  return prepareCases(cases, 0.0, 0.05, 0.3, 0.3);
}

TEST(PushTime, repeatingAPushTakesItsDurationAndTheHandling) {
  const auto cases = prepare({syntheticPush(1, 0.0, 2.0, 0.0, {})});
  PushTimeOptions options;
  options.handling_s = 3.0;
  const PushTime time(cases, options);
  EXPECT_NEAR(time.after(0, 0), cases[0].duration_s + 3.0, 1e-9);
}

TEST(PushTime, goingAroundTheObjectTakesHalfACircle) {
  constexpr double kPi = 3.14159265358979323846;
  const auto cases =
      prepare({syntheticPush(1, 0.0, 2.0, 0.0, {}), syntheticPush(2, kPi, 2.0, 0.0, {})});
  PushTimeOptions options;
  options.handling_s = 0.0;
  options.turn_rate_rps = 100.0;
  const PushTime time(cases, options);
  const double radius_m = 0.75 + options.clearance_m;
  const double way_m = kPi * radius_m + 2.0 * options.clearance_m;
  EXPECT_NEAR(time.after(0, 1), way_m / options.drive_speed_mps + cases[1].duration_s, 1e-9);
}

TEST(PushTime, theFirstPushBeginsAtTheRobot) {
  const auto cases = prepare({syntheticPush(1, 0.0, 2.0, 0.0, {})});
  const PushTimeOptions options;
  const PushTime time(cases, options);
  const double expected_s =
      options.handling_s + 2.25 / options.drive_speed_mps + cases[0].duration_s;
  EXPECT_NEAR(time.first(Pose2(-3.0, 0.0, 0.0), 0), expected_s, 1e-9);
}

TEST(PushTime, noChainBeatsTheLowerBound) {
  const auto cases = prepare(syntheticPushes(12, 3));
  const PushTime time(cases, PushTimeOptions{});
  Random random(4);
  for (int k = 0; k < 500; ++k) {
    int push = static_cast<int>(random.below(cases.size()));
    // The robot may already stand where the first push begins.
    double spent_s = time.first(cases[push].robot_begin, push);
    Pose2 pose = cases[push].start_outcome.mean;
    for (int i = static_cast<int>(random.below(6)); i > 0; --i) {
      const int next = random.chance(0.5) ? push : static_cast<int>(random.below(cases.size()));
      spent_s += time.after(push, next);
      pose = pose * cases[next].start_outcome.mean;
      push = next;
    }
    ASSERT_LE(time.lowerBound(pose.position().norm()), spent_s + 1e-9);
  }
  EXPECT_EQ(time.lowerBound(-1.0), 0.0);
}

}  // namespace
}  // namespace casepush
