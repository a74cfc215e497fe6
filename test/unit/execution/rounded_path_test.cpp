#include "../../../src/execution/rounded_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr CornerLimits kLimits{0.015, 0.005, 0.15, 0.6};

double distanceToSegments(const Eigen::Vector2d& p, const std::vector<Pose2>& waypoints) {
  double best = 1e9;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector2d a = waypoints[i - 1].position();
    const Eigen::Vector2d d = waypoints[i].position() - a;
    const double t = std::clamp((p - a).dot(d) / std::max(1e-12, d.squaredNorm()), 0.0, 1.0);
    best = std::min(best, (a + t * d - p).norm());
  }
  return best;
}

double turnAt(const std::vector<Pose2>& waypoints, std::size_t i) {
  const Eigen::Vector2d in = waypoints[i].position() - waypoints[i - 1].position();
  const Eigen::Vector2d out = waypoints[i + 1].position() - waypoints[i].position();
  return std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out)));
}

std::vector<Pose2> randomPath(Random* random) {
  std::vector<Pose2> waypoints{Pose2(1.0, -2.0, 0.3)};
  double heading = 0.0;
  for (int i = 0; i < 5; ++i) {
    heading += random->uniform(-1.6, 1.6);
    const double length = random->uniform(0.02, 0.6);
    const Pose2& last = waypoints.back();
    waypoints.emplace_back(last.x() + length * std::cos(heading),
                           last.y() + length * std::sin(heading),
                           last.yaw() + random->uniform(-0.5, 0.5));
  }
  return waypoints;
}

TEST(RoundedPath, staysWithinTheCutAndKeepsTheEnds) {
  Random random(3);
  for (int k = 0; k < 500; ++k) {
    const std::vector<Pose2> sharp = randomPath(&random);
    const RoundedPath rounded = roundCorners(sharp, kLimits);
    ASSERT_EQ(rounded.radius_m.size(), rounded.waypoints.size());
    EXPECT_LT(distance(rounded.waypoints.front(), sharp.front()), 1e-12);
    EXPECT_LT(distance(rounded.waypoints.back(), sharp.back()), 1e-12);
    EXPECT_NEAR(yawDifference(rounded.waypoints.back(), sharp.back()), 0.0, 1e-12);
    for (const Pose2& pose : rounded.waypoints) {
      EXPECT_LE(distanceToSegments(pose.position(), sharp), kLimits.cut_m + 1e-9);
    }
    for (const Pose2& corner : {sharp[1], sharp[sharp.size() - 2]}) {
      EXPECT_LE(distanceToSegments(corner.position(), rounded.waypoints), kLimits.end_cut_m + 1e-3);
    }
  }
}

TEST(RoundedPath, turnsByLittleAtEachPointOfAnArcAndLiesOnItsCircle) {
  Random random(4);
  int arcs = 0;
  for (int k = 0; k < 500; ++k) {
    const RoundedPath rounded = roundCorners(randomPath(&random), kLimits);
    for (std::size_t i = 1; i + 1 < rounded.waypoints.size(); ++i) {
      const double radius_m = rounded.radius_m[i];
      if (radius_m == 0.0 || std::isinf(radius_m)) continue;
      EXPECT_LT(turnAt(rounded.waypoints, i), 0.11);
      if (rounded.radius_m[i - 1] != radius_m || rounded.radius_m[i + 1] != radius_m) continue;
      const Eigen::Vector2d a = rounded.waypoints[i - 1].position();
      const Eigen::Vector2d b = rounded.waypoints[i].position();
      const Eigen::Vector2d c = rounded.waypoints[i + 1].position();
      const double area = std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
      EXPECT_NEAR((a - b).norm() * (b - c).norm() * (c - a).norm() / (2.0 * area), radius_m,
                  1e-6 * radius_m);
      ++arcs;
    }
  }
  EXPECT_GT(arcs, 500);
}

TEST(RoundedPath, roundsOnlyWhereTheRobotIsFasterAlongTheArc) {
  const auto radiusAt = [](double leg_m) {
    const RoundedPath rounded = roundCorners(
        {Pose2(), Pose2(leg_m, 0, 0), Pose2(leg_m, leg_m, 0), Pose2(3.0, leg_m, 0)}, kLimits);
    return rounded.radius_m[1];
  };
  // Sharp, the velocity turns by 90 degrees at 0.15 / sqrt(2) m/s; the arc allows that with a
  // radius of 19 mm, which a leg of 38 mm and a cut of 8 mm have room for; at the end it is 5 mm.
  EXPECT_EQ(radiusAt(0.01), 0.0);
  EXPECT_EQ(radiusAt(1.0), 0.0);
  const RoundedPath path = roundCorners(
      {Pose2(), Pose2(1, 0, 0), Pose2(2, 0, 0), Pose2(2, 1, 0), Pose2(3, 1, 0), Pose2(4, 1, 0)},
      kLimits);
  EXPECT_TRUE(std::isinf(path.radius_m[1]));
  EXPECT_NEAR(path.radius_m[2], 0.015 / (std::sqrt(2.0) - 1.0), 1e-9);
}

TEST(RoundedPath, leavesTurnsOnTheSpotAndShortPathsAlone) {
  for (const std::vector<Pose2>& path :
       {std::vector<Pose2>{Pose2(1, 2, 3)}, std::vector<Pose2>{Pose2(), Pose2(1, 0, 1)},
        std::vector<Pose2>{Pose2(), Pose2(1, 0, 0), Pose2(1, 0, 2), Pose2(1, 1, 2)}}) {
    const RoundedPath rounded = roundCorners(path, kLimits);
    ASSERT_EQ(rounded.waypoints.size(), path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_EQ(distance(rounded.waypoints[i], path[i]), 0.0);
    }
  }
}

}  // namespace
}  // namespace casepush
