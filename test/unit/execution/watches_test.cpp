#include "../../../src/execution/watches.h"

#include <gtest/gtest.h>

#include <limits>

#include "casepush/common/random.h"

namespace casepush {
namespace {

Observation at(double stamp_s, double robot_stamp_s) {
  Observation observation;
  observation.stamp_s = stamp_s;
  observation.robot_stamp_s = robot_stamp_s;
  return observation;
}

TEST(RobotWatch, tellsFreshStaleAndLost) {
  using Status = RobotWatch::Status;
  RobotWatch watch(0.2);
  EXPECT_EQ(watch.check(at(10.0, 9.9)), Status::kFresh);
  for (int i = 0; i <= 20; ++i) {
    EXPECT_EQ(watch.check(at(10.15 + 0.1 * i, 9.9)), Status::kStale);
  }
  EXPECT_EQ(watch.check(at(12.2, 9.9)), Status::kLost);
  EXPECT_EQ(watch.check(at(12.2, 12.2)), Status::kFresh);
  EXPECT_EQ(watch.check(at(std::numeric_limits<double>::quiet_NaN(), 12.2)), Status::kStale);
  Observation bad = at(12.3, 12.3);
  bad.map_T_robot = Pose2(std::numeric_limits<double>::infinity(), 0.0, 0.0);
  EXPECT_EQ(watch.check(bad), Status::kStale);
}

TEST(RobotWatch, countsFromTheBeginningIfThePoseNeverCame) {
  RobotWatch watch(0.2);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(watch.check(at(50.0 + 0.1 * i, 0.0)), RobotWatch::Status::kStale);
  }
  EXPECT_EQ(watch.check(at(52.1, 0.0)), RobotWatch::Status::kLost);
}

TEST(RobotWatch, doesNotTakeAClockThatJumpsForwardsForALostRobot) {
  using Status = RobotWatch::Status;
  RobotWatch watch(0.2);
  EXPECT_EQ(watch.check(at(10.0, 10.0)), Status::kFresh);
  EXPECT_EQ(watch.check(at(40.0, 10.0)), Status::kStale);
  EXPECT_EQ(watch.check(at(40.02, 40.02)), Status::kFresh);
}

TEST(TickClock, boundsTheStepAndNoticesAReset) {
  TickClock clock;
  EXPECT_DOUBLE_EQ(*clock.advance(100.0), 0.0);
  EXPECT_NEAR(*clock.advance(100.02), 0.02, 1e-12);
  EXPECT_DOUBLE_EQ(*clock.advance(105.0), 0.2);
  EXPECT_DOUBLE_EQ(*clock.advance(104.9), 0.0);
  EXPECT_FALSE(clock.advance(3.0));
}

class RestWatchTest : public testing::Test {
 protected:
  bool see(double stamp_s, double x_m, double speed_mps = 0.0, bool moving = false) {
    ObjectState object;
    object.stamp_s = stamp_s;
    object.map_T_object = Pose2(x_m, 0.0, 0.0);
    object.covariance = covariance_;
    object.twist.vx_mps = speed_mps;
    object.moving = moving;
    return watch_.isAtRest(object);
  }
  RestWatch watch_{ExecutePushOptions{}};
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

TEST_F(RestWatchTest, needsTheRestTimeByWhatWasSeen) {
  EXPECT_FALSE(see(1.0, 2.0));
  EXPECT_FALSE(see(1.2, 2.001));
  EXPECT_FALSE(see(1.2, 2.001));  // The same image does not count twice.
  EXPECT_TRUE(see(1.41, 2.0));
  EXPECT_DOUBLE_EQ(watch_.sinceS(), 1.0);
  EXPECT_TRUE(see(1.41, 2.0));
}

TEST_F(RestWatchTest, startsAnewOnMotion) {
  see(1.0, 2.0);
  EXPECT_FALSE(see(1.5, 2.0, 0.03));
  EXPECT_FALSE(see(1.8, 2.0));
  EXPECT_TRUE(see(1.91, 2.0));
  EXPECT_FALSE(see(2.0, 2.0, 0.0, true));
}

TEST_F(RestWatchTest, expectsTheScatterThatTheEstimatesHave) {
  constexpr double kSigmaM = 0.006;
  const auto rests = [this] {
    Random random(4);
    int seen_at_rest = 0;
    for (int i = 0; i < 400; ++i) seen_at_rest += see(0.05 * i, random.normal(kSigmaM)) ? 1 : 0;
    return seen_at_rest;
  };
  EXPECT_LT(rests(), 200);  // They say that they are exact, and so the object moves.
  watch_.reset();
  covariance_.diagonal() << kSigmaM * kSigmaM, kSigmaM * kSigmaM, 1e-4;
  EXPECT_GT(rests(), 380);
}

TEST_F(RestWatchTest, noticesCreepingHoweverBadTheEstimatesAre) {
  covariance_ = Eigen::Matrix3d::Identity();
  bool at_rest = false;
  for (int i = 0; i < 100; ++i) at_rest = at_rest || see(1.0 + 0.05 * i, 2.0 + 0.012 * i);
  EXPECT_FALSE(at_rest);
}

TEST_F(RestWatchTest, noticesCreeping) {
  bool at_rest = false;
  for (int i = 0; i < 50; ++i) {
    at_rest = at_rest || see(1.0 + 0.05 * i, 2.0 + 0.004 * i);  // 8 cm/s although the twist says 0.
  }
  EXPECT_FALSE(at_rest);
}

}  // namespace
}  // namespace casepush
