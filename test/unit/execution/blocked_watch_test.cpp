#include "../../../src/execution/blocked_watch.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace casepush {
namespace {

constexpr double kTickS = 0.02;

using Drive = BlockedWatch::Drive;

class BlockedWatchTest : public testing::Test {
 protected:
  // Lets time go on; the base does `share` of what it is told. Returns when the watch first says
  // that it is blocked, or -1.
  double drive(const Twist2& commanded, double share, double duration_s, Drive how = Drive::kFree) {
    return driveAs(commanded,
                   {share * commanded.vx_mps, share * commanded.vy_mps, share * commanded.wz_rps},
                   duration_s, how);
  }

  double driveAs(const Twist2& commanded, const Twist2& actual, double duration_s,
                 Drive how = Drive::kFree) {
    for (double t_s = 0.0; t_s < duration_s; t_s += kTickS) {
      const bool blocked = watch_.isBlocked(observation_, commanded, how);
      if (blocked) {
        return t_s;
      }
      observation_.robot_stamp_s += kTickS;
      observation_.map_T_robot =
          observation_.map_T_robot *
          expSe2(kTickS * Eigen::Vector3d(actual.vx_mps, actual.vy_mps, actual.wz_rps));
    }
    return -1.0;
  }

  BlockedWatch watch_;
  Observation observation_;
};

TEST_F(BlockedWatchTest, saysSoWithinAFifthOfASecond) {
  for (const Twist2& commanded :
       {Twist2{0.5, 0.0, 0.0}, Twist2{0.0, -0.15, 0.0}, Twist2{0.0, 0.0, 1.0}}) {
    for (const Drive how : {Drive::kFree, Drive::kPushing}) {
      EXPECT_LT(drive(commanded, 1.0, 1.0, how), 0.0);
      const double after_s = drive(commanded, 0.0, 1.0, how);
      EXPECT_GE(after_s, 0.1);
      EXPECT_LE(after_s, 0.22);
      watch_.reset();
    }
  }
}

TEST_F(BlockedWatchTest, isPatientWithAHeavyLoadAndASlowStart) {
  EXPECT_LT(drive({0.3, 0.0, 0.0}, 0.3, 2.0, Drive::kPushing), 0.0);
  EXPECT_LT(drive({0.3, 0.0, 0.0}, 0.0, 0.08, Drive::kPushing), 0.0);
  EXPECT_LT(drive({0.3, 0.0, 0.0}, 0.5, 1.0, Drive::kPushing), 0.0);
}

TEST_F(BlockedWatchTest, noticesThatAFreeRobotSlidesAlongSomething) {
  const Twist2 commanded{0.35, -0.35, 0.1};
  EXPECT_LT(drive(commanded, 1.0, 1.0), 0.0);
  const double after_s = driveAs(commanded, {0.0, -0.35, 0.1}, 1.0);
  EXPECT_GT(after_s, 0.1);
  EXPECT_LE(after_s, 0.22);
}

TEST_F(BlockedWatchTest, aPushingRobotMayBeDiverted) {
  const Twist2 commanded{0.2, -0.2, 0.0};
  EXPECT_LT(drive(commanded, 1.0, 1.0, Drive::kPushing), 0.0);
  EXPECT_LT(driveAs(commanded, {0.0, -0.2, 0.0}, 1.0, Drive::kPushing), 0.0);
}

TEST_F(BlockedWatchTest, aRobotThatShouldStandIsNotBlocked) {
  EXPECT_LT(drive(Twist2{}, 0.0, 1.0), 0.0);
  // The last millimetres beside an object.
  EXPECT_LT(drive({0.05, 0.0, 0.0}, 0.0, 1.0), 0.0);
}

TEST_F(BlockedWatchTest, aRobotThatTurnsBackIsNotBlocked) {
  // Forth and back at 0.8 m/s^2, with a base that lags behind by a tenth of a second.
  double commanded_mps = 0.0;
  double actual_mps = 0.0;
  for (int i = 0; i < 500; ++i) {
    const double wanted_mps = (i / 50) % 2 == 0 ? 0.3 : -0.3;
    const double change_mps = 0.8 * kTickS;
    commanded_mps += std::clamp(wanted_mps - commanded_mps, -change_mps, change_mps);
    actual_mps += kTickS / 0.1 * (commanded_mps - actual_mps);
    observation_.robot_stamp_s += kTickS;
    observation_.map_T_robot = observation_.map_T_robot * Pose2(kTickS * actual_mps, 0.0, 0.0);
    EXPECT_FALSE(watch_.isBlocked(observation_, {commanded_mps, 0.0, 0.0}, Drive::kFree))
        << "tick " << i;
  }
}

TEST_F(BlockedWatchTest, takesNoLatePoseForARobotThatStands) {
  const Twist2 commanded{0.5, 0.0, 0.0};
  EXPECT_LT(drive(commanded, 1.0, 1.0), 0.0);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(watch_.isBlocked(observation_, commanded, Drive::kFree));
  }
}

TEST_F(BlockedWatchTest, knowsNothingOfTimeThatItHasNotSeen) {
  EXPECT_LT(drive({0.5, 0.0, 0.0}, 0.0, 0.18), 0.0);
  observation_.robot_stamp_s += 5.0;
  EXPECT_GT(drive({0.5, 0.0, 0.0}, 0.0, 2.0), 0.15);
}

TEST_F(BlockedWatchTest, waitsForACommandToReachTheBase) {
  EXPECT_LT(drive({0.5, 0.0, 0.0}, 0.0, 0.8), 0.0);
  EXPECT_LT(drive({0.5, 0.0, 0.0}, 1.0, 0.5), 0.0);
  EXPECT_LT(drive(Twist2{}, 0.0, 0.5), 0.0);
  const double after_s = drive({0.5, 0.0, 0.0}, 0.0, 2.0);
  EXPECT_GT(after_s, 1.0);
  EXPECT_LT(after_s, 1.3);
}

}  // namespace
}  // namespace casepush
