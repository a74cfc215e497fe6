#include "casepush/ros/stand_tally.h"

#include <gtest/gtest.h>

namespace casepush {
namespace {

TEST(StandTally, tellsOfTheFirstTimeAtOnce) {
  StandTally tally;
  EXPECT_EQ(tally.add(0.0, 500.0, ""), "");
  EXPECT_EQ(tally.add(0.02, 500.1, "a is stale"), "the base is told to stand: a is stale");
  EXPECT_EQ(tally.add(0.04, 500.2, "a is stale"), "");
  EXPECT_EQ(tally.add(0.06, 500.3, ""), "");
  EXPECT_EQ(tally.add(0.08, 500.4, "a is stale"), "");
  EXPECT_EQ(tally.add(0.10, 500.5, "b is stale"), "");
}

TEST(StandTally, sumsUpWhatFollowsOnceAMinute) {
  StandTally tally;
  double now_s = 0.0;
  const auto tick = [&](double wall_s, const std::string& reason) {
    return tally.add(now_s += 0.02, wall_s, reason);
  };
  EXPECT_NE(tick(0.0, "a is stale"), "");
  for (int i = 0; i < 225; ++i) {
    EXPECT_EQ(tick(1.0, ""), "");
    EXPECT_EQ(tick(1.0, "a is stale"), "");
    EXPECT_EQ(tick(1.0, "a is stale"), "");
  }
  EXPECT_EQ(tick(2.0, "b is stale"), "");
  EXPECT_EQ(tick(59.9, ""), "");
  EXPECT_EQ(tick(64.0, ""),
            "in the last 64 s the base was told to stand 225 times (9.00 s in all) because a is "
            "stale, 1 time (0.02 s in all) because b is stale");
  EXPECT_EQ(tick(200.0, ""), "");
}

TEST(StandTally, tellsThatTheBaseStillStands) {
  StandTally tally;
  std::string last;
  for (int i = 0; i <= 1250; ++i) {
    const std::string line = tally.add(0.1 * i, 0.1 * i, "a is stale");
    if (!line.empty()) last = line;
  }
  EXPECT_EQ(last,
            "in the last 60 s the base was told to stand still (60.00 s in all) because a is "
            "stale");
}

TEST(StandTally, leavesJumpsOfTheClockOut) {
  StandTally tally;
  tally.add(1.0, 0.0, "b is stale");
  for (const double now_s : {1.0, 1.1, 500.0, 2.0}) tally.add(now_s, 1.0, "a is stale");
  EXPECT_EQ(tally.add(2.1, 60.0, ""),
            "in the last 60 s the base was told to stand 1 time (0.40 s in all) because a is "
            "stale");
}

}  // namespace
}  // namespace casepush
