#include "casepush/world/shadow.h"

#include <gtest/gtest.h>

#include "casepush/world/collision_checker.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

PlacedShape box(double x, double y, double z, const Eigen::Isometry3d& pose) {
  return {Box{{x, y, z}}, pose, "box"};
}

TEST(ShadowTest, separationOfRectanglesHasClosedForm) {
  const Shadow unit = rectangle({0, 0}, {1, 1});
  EXPECT_DOUBLE_EQ(separation(unit, rectangle({3, 0}, {4, 1})), 2.0);
  EXPECT_DOUBLE_EQ(separation(unit, rectangle({4, 5}, {6, 6})), 5.0);
  EXPECT_DOUBLE_EQ(separation(unit, rectangle({0.8, -1}, {6, 6})), -0.2);
  EXPECT_DOUBLE_EQ(separation(unit, rectangle({1, 0}, {2, 1})), 0.0);
  EXPECT_DOUBLE_EQ(separation(unit, Eigen::Vector2d(4, 5)), 5.0);
  EXPECT_DOUBLE_EQ(separation(unit, Eigen::Vector2d(0.5, 0.9)), -0.1);
}

TEST(ShadowTest, separationOfDiscsCountsTheirRadii) {
  const ConvexPart cylinder({Cylinder{0.3, 1.0}, placed(0, 0, 0.5), "c"});
  const Shadow disc = cylinder.shadow();
  EXPECT_NEAR(separation(disc, transformed({1, 0, 2}, disc)), 0.4, 1e-12);
  EXPECT_NEAR(separation(disc, rectangle({0.5, -1}, {1, 1})), 0.2, 1e-12);
  EXPECT_NEAR(separation(disc, rectangle({0.5, 0.5}, {1, 1})), std::sqrt(0.5) - 0.3, 1e-12);
  EXPECT_NEAR(separation(disc, Eigen::Vector2d(0.1, 0.0)), -0.2, 1e-12);
  EXPECT_TRUE(closerThan(disc, transformed({1, 0, 2}, disc), 0.41));
  EXPECT_FALSE(closerThan(disc, transformed({1, 0, 2}, disc), 0.39));
}

TEST(ConvexPartTest, sphereIsNarrowerAwayFromItsEquator) {
  const ConvexPart sphere({Sphere{0.5}, placed(0, 0, 0.5), "s"});
  EXPECT_NEAR(sphere.shadow(0.8, 2.0).radius_m, 0.4, 1e-12);
  EXPECT_NEAR(sphere.shadow(0.2, 0.7).radius_m, 0.5, 1e-12);
  EXPECT_TRUE(sphere.shadow(1.0, 2.0).empty());
}

TEST(ConvexPartTest, tiltedBoxIsCutAtTheSlab) {
  // A square of edge 1 on its edge: at height z its section is a strip of width 2 z.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(0, 0, std::sqrt(0.5)));
  pose.rotate(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()));
  const ConvexPart part(box(2, 1, 1, pose));
  EXPECT_FALSE(part.isPrism());
  const Shadow cut = part.shadow(0.1, 0.2);
  EXPECT_NEAR(separation(cut, Eigen::Vector2d(0.0, 1.0)), 0.8, 1e-12);
  EXPECT_NEAR(separation(cut, Eigen::Vector2d(3.0, 0.0)), 2.0, 1e-12);
  EXPECT_NEAR(separation(part.shadow(), Eigen::Vector2d(0.0, 1.0)), 1.0 - std::sqrt(0.5), 1e-12);
}

TEST(ConvexPartTest, lyingBoxIsAPrismAndLyingCylinderIsCovered) {
  Eigen::Isometry3d lying = placed(0, 0, 0.3);
  lying.rotate(Eigen::AngleAxisd(1.570796, Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(ConvexPart(box(1, 2, 3, lying)).isPrism());
  const ConvexPart wheel({Cylinder{0.3, 0.1}, lying, "wheel"});
  EXPECT_FALSE(wheel.isPrism());
  // At 0.05 m height the wheel is 2 sqrt(0.3^2 - 0.25^2) long.
  const double half = std::sqrt(0.09 - 0.0625);
  const double reach = 1.0 - separation(wheel.shadow(0.0, 0.05), Eigen::Vector2d(1.0, 0.0));
  EXPECT_GE(reach, half);
  EXPECT_LE(reach, half + 0.03);
}

TEST(SolidsOverlapTest, agreesWithClosedForms) {
  const Solid sphere{{Sphere{0.5}, placed(0, 0, 0.5), "s"}};
  const Solid high_sphere{{Sphere{0.5}, placed(0, 0, 1.1), "s"}};
  // Centres 0.6 apart in height: they touch at a horizontal distance of 0.8.
  EXPECT_TRUE(solidsOverlap(sphere, {}, high_sphere, {0.799, 0, 1}));
  EXPECT_FALSE(solidsOverlap(sphere, {}, high_sphere, {0.801, 0, 1}));
  const Solid post{{Cylinder{0.1, 0.4}, placed(0, 0, 1.0), "p"}};
  // The post begins at 0.8, where the sphere's radius is 0.4.
  EXPECT_TRUE(solidsOverlap(sphere, {}, post, {0, 0.499, 0}));
  EXPECT_FALSE(solidsOverlap(sphere, {}, post, {0, 0.501, 0}));
  const Solid cube{box(1, 1, 1, placed(0, 0, 0.5))};
  EXPECT_TRUE(solidsOverlap(cube, {}, cube, {1.2, 0, M_PI / 4}));
  EXPECT_FALSE(solidsOverlap(cube, {}, cube, {1.21, 0, M_PI / 4}));
  const Solid on_top{box(1, 1, 1, placed(0, 0, 1.5))};
  EXPECT_FALSE(solidsOverlap(cube, {}, on_top, {0.2, 0.1, 0.3})) << "standing on it is no overlap";
}

TEST(SolidsOverlapTest, isSymmetricAndIgnoresTheMapFrame) {
  Random random(5);
  const Solid table = overbedTable();
  const Solid stool{{Cylinder{0.2, 0.06}, placed(0, 0, 0.5), "seat"},
                    {box(0.3, 0.05, 0.5, placed(0, 0, 0.25, 0.4, 0.2))},
                    {Sphere{0.06}, placed(0.1, 0.1, 0.06), "ball"}};
  int overlaps = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose2 a = randomPose(&random, -0.5, 0.5);
    const Pose2 b = randomPose(&random, -0.5, 0.5);
    const bool overlap = solidsOverlap(table, a, stool, b);
    overlaps += overlap;
    EXPECT_EQ(overlap, solidsOverlap(stool, b, table, a));
    EXPECT_EQ(overlap, solidsOverlap(table, {}, stool, a.inverse() * b));
  }
  EXPECT_GT(overlaps, 300);
  EXPECT_LT(overlaps, 1700);
}

TEST(OverlapDepthTest, tiltedPairsAreNeverMissed) {
  Random random(6);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const ConvexPart a(box(0.4, 0.3, 0.5, placed(0, 0, 0.3, 0.2, random.uniform(0.1, 0.7))));
    const ConvexPart b(box(0.2, 0.5, 0.4, placed(0, 0, 0.5, 1.0, random.uniform(0.1, 0.7))));
    const Pose2 pose = randomPose(&random, -0.5, 0.5);
    // Oracle: narrow slabs that overlap in a common inner height prove an overlap.
    bool certain = false;
    for (double z = 0.0; z < 0.9; z += 0.01) {
      const Shadow at_a = a.shadow(z, z + 1e-5);
      const Shadow at_b = b.shadow(z, z + 1e-5);
      if (at_a.count < 3 || at_b.count < 3) continue;
      certain |= separation(at_a, transformed(pose, at_b)) < -1e-3;
    }
    found += certain;
    if (!certain) continue;
    EXPECT_GT(overlapDepth(a, {}, b, pose, 0.0), 0.0);
  }
  EXPECT_GT(found, 200);
}

}  // namespace
}  // namespace casepush
