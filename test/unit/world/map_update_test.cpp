#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <memory>

#include "world/random_motion.h"

namespace casepush {
namespace {

constexpr double kResolution_m = 0.05;
constexpr double kReach_m = 4.0;

/// A map in which boxes of points come and go.
class MapUpdateTest : public testing::Test {
 protected:
  MapUpdateTest() : random_(5), map_(mapOf(randomRoom(&random_, 6.0, 8), kResolution_m)) {}

  /// Scans a patch of a wall from 1 m away, which frees what lies in between. Returns the area.
  CollisionChecker::Area change(double low_m, double high_m) {
    const Pose2 wall = randomPose(&random_, low_m, high_m);
    const double z_m = random_.uniform(0.1, 1.5);
    std::vector<Eigen::Vector3f> points;
    CollisionChecker::Area area{wall.position(), wall.position()};
    const auto include = [&area](const Eigen::Vector2d& point) {
      area.min_m = area.min_m.cwiseMin(point);
      area.max_m = area.max_m.cwiseMax(point);
    };
    for (int i = -4; i <= 4; ++i) {
      const Eigen::Vector2d point = wall * Eigen::Vector2d(0.0, 0.04 * i);
      points.emplace_back(point.x(), point.y(), z_m);
      include(point);
    }
    const Eigen::Vector2d origin = wall * Eigen::Vector2d(1.0, 0.0);
    include(origin);
    map_.addScan({static_cast<float>(origin.x()), static_cast<float>(origin.y()), 0.5F}, points,
                 5.0);
    area.min_m.array() -= kResolution_m;
    area.max_m.array() += kResolution_m;
    return area;
  }

  static void expectSame(const CollisionChecker& updated, const CollisionChecker& anew) {
    EXPECT_EQ(updated.columns().bits, anew.columns().bits);
    EXPECT_EQ(updated.columns().origin_m, anew.columns().origin_m);
    EXPECT_EQ(updated.columns().width, anew.columns().width);
    EXPECT_EQ(updated.mapColumns()->bits, anew.mapColumns()->bits);
  }

  Random random_;
  Map map_;
};

TEST_F(MapUpdateTest, isTheSameAsAMapMadeAnew) {
  CollisionChecker checker(map_);
  checker.setObstacles({{overbedTable(), {3.0, 3.0, 0.4}, "table"}});
  const auto object = checker.footprint(leaningSolid());
  const auto robot = checker.footprint(roundRobot());
  const auto classes = SweepChecker::heightClasses(checker, {object, robot});
  SweepChecker sweeps(checker, classes, kReach_m);
  const Sweep sweep(tracksOf(randomMotion(&random_, 20), object, robot), classes);
  int changed = 0;
  for (int i = 0; i < 40; ++i) {
    // Sometimes beyond what was known.
    const CollisionChecker::Area area = i % 4 == 0 ? change(-1.0, 7.5) : change(1.2, 4.8);
    const auto before = checker.mapColumns();
    checker = checker.updated(map_, area);
    sweeps = sweeps.updated(checker, area);
    CollisionChecker anew(map_);
    anew.setObstacles(checker.obstacles());
    expectSame(checker, anew);
    EXPECT_EQ(sweeps.fingerprint(), SweepChecker(anew, classes, kReach_m).fingerprint());
    changed += before->bits != checker.mapColumns()->bits;
    for (int k = 0; k < 30; ++k) {
      const Pose2 start = randomPose(&random_, 0.0, 6.0);
      ASSERT_EQ(checker.collides(*object, start), anew.collides(*object, start));
      ASSERT_EQ(sweeps.collides(sweep, start), sweeps.collidesPoseByPose(sweep, start));
    }
  }
  EXPECT_GT(changed, 20);
}

TEST_F(MapUpdateTest, boundsAreThoseOfAllKnownCells) {
  for (int i = 0; i < 10; ++i) change(-1.0, 7.5);
  Eigen::Vector3d low = map_.max();
  Eigen::Vector3d high = map_.min();
  for (auto leaf = map_.tree().begin_leafs(); leaf != map_.tree().end_leafs(); ++leaf) {
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    low = low.cwiseMin((centre.array() - leaf.getSize() / 2.0).matrix());
    high = high.cwiseMax((centre.array() + leaf.getSize() / 2.0).matrix());
  }
  EXPECT_LT((map_.min() - low).norm(), 1e-9);
  EXPECT_LT((map_.max() - high).norm(), 1e-9);
}

TEST_F(MapUpdateTest, tellsWhereItDiffersFromAnOlderMap) {
  EXPECT_EQ(map_.changeSince(map_).cells, 0);
  EXPECT_TRUE(map_.changeSince(map_).where_m.isEmpty());
  for (int i = 0; i < 20; ++i) {
    const Map before = map_.copy();
    const CollisionChecker::Area area = change(0.5, 5.5);
    const MapChange found = map_.changeSince(before);
    EXPECT_EQ(before.changeSince(map_).cells, found.cells);
    int cells = 0;
    Eigen::AlignedBox3d box;
    const auto compare = [&](const octomap::OcTree& a, const octomap::OcTree& b) {
      for (auto leaf = a.begin_leafs(); leaf != a.end_leafs(); ++leaf) {
        if (!a.isNodeOccupied(*leaf)) continue;
        const double half_m = leaf.getSize() / 2.0;
        for (double x = -half_m + 0.025; x < half_m; x += kResolution_m) {
          for (double y = -half_m + 0.025; y < half_m; y += kResolution_m) {
            for (double z = -half_m + 0.025; z < half_m; z += kResolution_m) {
              const Eigen::Vector3d centre(leaf.getX() + x, leaf.getY() + y, leaf.getZ() + z);
              const octomap::OcTreeNode* other = b.search(centre.x(), centre.y(), centre.z());
              if (other != nullptr && b.isNodeOccupied(other)) continue;
              ++cells;
              const Eigen::Vector3d half = Eigen::Vector3d::Constant(kResolution_m / 2.0);
              box.extend(Eigen::AlignedBox3d(centre - half, centre + half));
            }
          }
        }
      }
    };
    compare(before.tree(), map_.tree());
    compare(map_.tree(), before.tree());
    EXPECT_EQ(found.cells, cells);
    if (cells == 0) continue;
    EXPECT_LT((found.where_m.min() - box.min()).norm(), 1e-6);
    EXPECT_LT((found.where_m.max() - box.max()).norm(), 1e-6);
    EXPECT_GE(found.where_m.min().x(), area.min_m.x() - 1e-6);
    EXPECT_LE(found.where_m.max().y(), area.max_m.y() + 1e-6);
  }
}

TEST_F(MapUpdateTest, leavesTheOldCheckerAsItWas) {
  const CollisionChecker checker(map_);
  const std::vector<std::uint64_t> bits = checker.columns().bits;
  const CollisionChecker::Area area = change(2.0, 4.0);
  const CollisionChecker newer = checker.updated(map_, area);
  EXPECT_EQ(checker.columns().bits, bits);
  EXPECT_NE(newer.columns().bits, bits);
}

TEST_F(MapUpdateTest, anEmptyMapMayGrow) {
  const CollisionChecker empty((Map(kResolution_m)));
  const CollisionChecker grown = empty.updated(map_, {map_.min().head<2>(), map_.max().head<2>()});
  EXPECT_EQ(grown.columns().bits, CollisionChecker(map_).columns().bits);
}

}  // namespace
}  // namespace casepush
