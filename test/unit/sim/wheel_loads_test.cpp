#include "wheel_loads.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "casepush/common/random.h"

namespace casepush::sim {
namespace {

using Eigen::Vector2d;

std::vector<double> loadsOf(const std::vector<Vector2d>& points, double total,
                            const Vector2d& moment) {
  std::vector<double> loads(points.size());
  EXPECT_TRUE(shareLoad(points, total, moment, loads));
  return loads;
}

TEST(ShareLoad, threePointsBearWhatStaticsSays) {
  const auto loads = loadsOf({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}, 100.0, {20.0, 50.0});
  EXPECT_NEAR(loads[1], 20.0, 1e-9);
  EXPECT_NEAR(loads[2], 50.0, 1e-9);
  EXPECT_NEAR(loads[0], 30.0, 1e-9);
}

TEST(ShareLoad, keepsForceAndMomentAndIsLinearInPlace) {
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<Vector2d> points;
    Vector2d centre = Vector2d::Zero();
    for (int i = 0; i < 5; ++i) {
      points.emplace_back(std::cos(1.2566 * i) + random.uniform(-0.1, 0.1),
                          std::sin(1.2566 * i) + random.uniform(-0.1, 0.1));
      centre += points.back() / 5.0;
    }
    const Vector2d place = centre + Vector2d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
    const auto loads = loadsOf(points, 80.0, 80.0 * place);
    Vector2d moment = Vector2d::Zero();
    for (std::size_t i = 0; i < 5; ++i) moment += loads[i] * points[i];
    EXPECT_NEAR(std::accumulate(loads.begin(), loads.end(), 0.0), 80.0, 1e-9);
    EXPECT_LT((moment - 80.0 * place).norm(), 1e-9);
    // Springs below a rigid body: loads are a plane over the floor, fixed by any three.
    Eigen::Matrix3d plane;
    for (int i = 0; i < 3; ++i)
      plane.row(i) << 1.0, points[static_cast<std::size_t>(i)].transpose();
    const Eigen::Vector3d slope = plane.inverse() * Eigen::Vector3d(loads[0], loads[1], loads[2]);
    EXPECT_NEAR(slope.dot(Eigen::Vector3d(1.0, points[4].x(), points[4].y())), loads[4], 1e-8);
  }
}

TEST(ShareLoad, liftsWheelsThatWouldPull) {
  const auto loads =
      loadsOf({{-1.0, -1.0}, {-1.0, 1.0}, {1.0, -1.0}, {1.0, 1.0}}, 100.0, {90.0, 0.0});
  EXPECT_EQ(loads[0] > 0.0, loads[1] > 0.0);
  EXPECT_NEAR(loads[2] + loads[3] + loads[0] + loads[1], 100.0, 1e-9);
  const auto over =
      loadsOf({{-1.0, -1.0}, {-1.0, 1.0}, {1.0, -1.0}, {1.0, 1.0}}, 100.0, {150.0, 0.0});
  EXPECT_EQ(over[0], 0.0);
  EXPECT_NEAR(over[2], 50.0, 1e-9);
}

TEST(ShareLoad, refusesLines) {
  std::vector<double> loads(3);
  EXPECT_FALSE(shareLoad({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}}, 1.0, {1.0, 1.0}, loads));
  loads.resize(2);
  EXPECT_FALSE(shareLoad({{0.0, 0.0}, {1.0, 0.0}}, 1.0, {0.5, 0.0}, loads));
}

}  // namespace
}  // namespace casepush::sim
