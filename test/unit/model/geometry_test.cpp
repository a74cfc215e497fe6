#include "casepush/model/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "casepush/common/random.h"

namespace casepush {
namespace {

PlacedShape placed(const Shape& shape, const Eigen::Vector3d& position_m,
                   const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  PlacedShape result{shape, Eigen::Isometry3d::Identity(), "part"};
  result.frame_T_shape.translate(position_m).rotate(rotation);
  return result;
}

Eigen::Quaterniond lying() {  // the shape's z axis along the frame's y axis
  return Eigen::Quaterniond(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitX()));
}

TEST(CircumscribedRadius, matchesClosedForms) {
  constexpr double kTolerance = 2e-5;  // relative; it may only overestimate
  const struct {
    PlacedShape shape;
    double radius_m;
  } cases[] = {
      {placed(Box{{0.6, 0.8, 5.0}}, {0, 0, 1}), 0.5},
      {placed(Box{{0.6, 0.8, 5.0}}, {0.1, -0.2, 1}), std::hypot(0.4, 0.6)},
      {placed(Box{{0.6, 2.0, 0.8}}, {0, 0, 0}, lying()), std::hypot(0.3, 0.4)},
      {placed(Sphere{0.3}, {0.3, 0.4, 0}), 0.8},
      {placed(Cylinder{0.25, 9.0}, {-0.3, 0.4, 0}), 0.75},
      {placed(Cylinder{0.3, 0.8}, {0, 0, 0}, lying()), 0.5},
  };
  for (const auto& test : cases) {
    const double radius_m = circumscribedRadius({test.shape});
    EXPECT_GE(radius_m, test.radius_m * (1.0 - 1e-12));
    EXPECT_LE(radius_m, test.radius_m * (1.0 + kTolerance));
  }
}

TEST(CircumscribedRadius, isTheLargestOfAllShapesAndZeroForNone) {
  EXPECT_EQ(circumscribedRadius({}), 0.0);
  EXPECT_NEAR(circumscribedRadius({placed(Sphere{0.3}, {0, 0, 0}), placed(Sphere{0.1}, {1, 0, 0})}),
              1.1, 1e-4);
}

TEST(CircumscribedRadius, coversEveryPointOfTiltedCylinders) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Cylinder cylinder{random.uniform(0.05, 0.5), random.uniform(0.05, 1.0)};
    const Eigen::Quaterniond rotation(
        Eigen::AngleAxisd(random.uniform(0, M_PI), Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(random.uniform(0, M_PI), Eigen::Vector3d::UnitY()));
    const PlacedShape shape =
        placed(cylinder, {random.uniform(-1, 1), random.uniform(-1, 1), 1.0}, rotation);
    double farthest_m = 0.0;
    double lowest_m = 1e9;
    for (int i = 0; i < 3600; ++i) {
      const double angle_rad = 2.0 * M_PI * i / 3600;
      for (const double end : {-0.5, 0.5}) {
        const Eigen::Vector3d point =
            shape.frame_T_shape * Eigen::Vector3d(cylinder.radius_m * std::cos(angle_rad),
                                                  cylinder.radius_m * std::sin(angle_rad),
                                                  end * cylinder.length_m);
        farthest_m = std::max(farthest_m, point.head<2>().norm());
        lowest_m = std::min(lowest_m, point.z());
      }
    }
    EXPECT_GE(circumscribedRadius({shape}), farthest_m);
    EXPECT_LE(circumscribedRadius({shape}), farthest_m * 1.0001);
    EXPECT_NEAR(heightRange(shape).low_m, lowest_m, 1e-5);
  }
}

TEST(HeightRange, matchesClosedForms) {
  const HeightRange standing = heightRange(placed(Cylinder{0.1, 0.6}, {0, 0, 1}));
  EXPECT_NEAR(standing.low_m, 0.7, 1e-12);
  EXPECT_NEAR(standing.high_m, 1.3, 1e-12);
  const HeightRange wheel = heightRange(placed(Cylinder{0.1, 0.6}, {0, 0, 0.1}, lying()));
  EXPECT_NEAR(wheel.low_m, 0.0, 1e-12);
  EXPECT_NEAR(wheel.high_m, 0.2, 1e-12);
  const HeightRange both =
      heightRange({placed(Sphere{0.1}, {0, 0, 0.3}), placed(Box{{1, 1, 0.2}}, {5, 5, 0.1})});
  EXPECT_NEAR(both.low_m, 0.0, 1e-12);
  EXPECT_NEAR(both.high_m, 0.4, 1e-12);
}

TEST(HeightRangeDeathTest, refusesNothing) {
  EXPECT_DEATH(heightRange(Solid{}), "height of nothing");
}

}  // namespace
}  // namespace casepush
