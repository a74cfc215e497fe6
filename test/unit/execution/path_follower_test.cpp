#include "../../../src/execution/path_follower.h"

#include <gtest/gtest.h>

#include <cmath>

namespace casepush {
namespace {

constexpr double kTickS = 0.02;
constexpr TrackingGains kGains{2.0, 2.5};

double distanceToPath(const Pose2& pose, const std::vector<Pose2>& waypoints) {
  double best = 1e9;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector2d a = waypoints[i - 1].position();
    const Eigen::Vector2d d = waypoints[i].position() - a;
    const double t =
        std::clamp((pose.position() - a).dot(d) / std::max(1e-12, d.squaredNorm()), 0.0, 1.0);
    best = std::min(best, (a + t * d - pose.position()).norm());
  }
  return best;
}

struct Drive {
  Pose2 end;
  double worst_m = 0.0;
  Pose2 worst_at;
  double duration_s = 0.0;
  double dock_speed_mps = 0.0;
  bool arrived = false;
};

Drive drive(const std::vector<Pose2>& waypoints, PathFollower::Speeds speeds = {0.5, 0.15}) {
  const RobotLimits limits;
  PathFollower follower(waypoints, limits, speeds);
  CommandLimiter limiter(limits);
  Drive drive;
  drive.end = waypoints.front();
  while (drive.duration_s < 120.0 && !drive.arrived) {
    const Reference reference = follower.advance(kTickS, drive.end);
    const Twist2 twist = limiter.limit(track(drive.end, reference, kGains), kTickS);
    drive.end =
        drive.end * expSe2(kTickS * Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps));
    const double off_m = distanceToPath(drive.end, waypoints);
    drive.worst_at = off_m > drive.worst_m ? drive.end : drive.worst_at;
    drive.worst_m = std::max(drive.worst_m, off_m);
    drive.duration_s += kTickS;
    if (follower.docking() && follower.remaining() < 0.2) {
      drive.dock_speed_mps = std::max(drive.dock_speed_mps, twist.speed());
    }
    drive.arrived = follower.atEnd() && distance(drive.end, waypoints.back()) < 0.005 &&
                    std::abs(yawDifference(drive.end, waypoints.back())) < 0.01;
  }
  return drive;
}

TEST(PathFollower, keepsToThePathAroundCorners) {
  const std::vector<Pose2> paths[] = {
      {Pose2(0, 0, 0), Pose2(2, 0, 0), Pose2(2, 2, 1.5), Pose2(3, 2, 0)},
      {Pose2(0, 0, 0), Pose2(2, 0, 3.1), Pose2(0.1, 0.1, -1.0)},
      {Pose2(0, 0, 1), Pose2(0.3, 0, 1), Pose2(0.3, 0.3, 1), Pose2(0, 0.3, -2), Pose2(0, 0.6, -2)},
  };
  for (const std::vector<Pose2>& path : paths) {
    const Drive result = drive(path);
    EXPECT_TRUE(result.arrived);
    EXPECT_LT(result.worst_m, 0.025) << "at " << result.worst_at.x() << " " << result.worst_at.y();
  }
}

TEST(PathFollower, isFastFarAwayAndSlowAtTheEnd) {
  const Drive result = drive({Pose2(0, 0, 0), Pose2(5, 0, 0), Pose2(5.3, 0, 0)});
  EXPECT_TRUE(result.arrived);
  EXPECT_LT(result.duration_s, 16.0);
  EXPECT_GT(result.duration_s, 10.0);
  EXPECT_LE(result.dock_speed_mps, 0.16);
}

TEST(PathFollower, hardlySlowsDownAroundAnObject) {
  std::vector<Pose2> around;
  double length_m = 0.0;
  for (int i = 0; i <= 9; ++i) {
    const double angle = i * M_PI / 6.0;
    around.emplace_back(0.8 * std::cos(angle), 0.8 * std::sin(angle), 0.1 * i);
    if (i > 0) length_m += distance(around[i - 1], around[i]);
  }
  const Drive result = drive(around, {0.5, 0.5});
  EXPECT_TRUE(result.arrived);
  EXPECT_LT(result.worst_m, 0.025);
  // Half a second to get to speed, half a second to brake, some tenths to settle.
  EXPECT_LT(result.duration_s, length_m / 0.5 + 1.6);
}

TEST(PathFollower, turnsWhileItBacksOff) {
  const Drive alone = drive({Pose2(0, 0, 0), Pose2(0, 0, 1)}, {0.5, 0.5});
  const Drive both = drive({Pose2(0, 0, 0), Pose2(-0.1, 0.05, 1)}, {0.5, 0.5});
  EXPECT_TRUE(both.arrived);
  EXPECT_LT(both.duration_s, alone.duration_s + 0.1);
}

TEST(PathFollower, turnsOnTheSpotWithinTheYawRate) {
  const Drive result = drive({Pose2(0, 0, 0), Pose2(0, 0, 3.0)});
  EXPECT_TRUE(result.arrived);
  EXPECT_GT(result.duration_s, 3.0);
  EXPECT_LT(result.worst_m, 1e-6);
}

TEST(PathFollower, acceptsAPathWithoutLength) {
  EXPECT_TRUE(drive({Pose2(1, 2, 3)}).arrived);
  EXPECT_TRUE(drive({Pose2(1, 2, 3), Pose2(1, 2, 3)}).arrived);
  EXPECT_TRUE(drive({Pose2(1, 2, 3), Pose2(1, 2, 3), Pose2(1.001, 2, 3)}).arrived);
}

TEST(PathFollower, waitsForARobotThatIsHeldBack) {
  PathFollower follower({Pose2(0, 0, 0), Pose2(3, 0, 0)}, RobotLimits{}, {0.5, 0.15});
  Reference reference;
  for (int i = 0; i < 1000; ++i) {
    reference = follower.advance(kTickS, Pose2());
  }
  EXPECT_LT(reference.map_T_reference.x(), 0.15);
  EXPECT_FALSE(follower.atEnd());
}

}  // namespace
}  // namespace casepush
