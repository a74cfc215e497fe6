#include "casepush/world/collision_checker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/world/shadow.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

/// Upright shape and a margin, as an independent reference sees them.
struct Reference {
  Solid solid;
  double margin_m;

  enum class Answer { kFree, kHit, kUnsure };

  /// Distance of the horizontal rectangle of a box and an axis-aligned square: 0 if a corner of one
  /// is in the other or edges cross, else that of the closest corner.
  static double rectangleDistance(const Pose2& map_T_box, const Eigen::Vector2d& half,
                                  const Eigen::Vector2d& centre, double half_square) {
    const Pose2 map_T_square(centre.x(), centre.y(), 0.0);
    const Eigen::Vector2d square = Eigen::Vector2d::Constant(half_square);
    const Eigen::Vector2d signs[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    std::array<Eigen::Vector2d, 4> of_box;
    std::array<Eigen::Vector2d, 4> of_square;
    double distance = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
      of_box[i] = map_T_box * Eigen::Vector2d(signs[i].cwiseProduct(half));
      of_square[i] = centre + signs[i] * half_square;
      distance = std::min({distance, pointDistance(map_T_square, square, of_box[i]),
                           pointDistance(map_T_box, half, of_square[i])});
    }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        if (cross(of_box[i], of_box[(i + 1) % 4], of_square[j], of_square[(j + 1) % 4])) return 0.0;
      }
    }
    return distance;
  }

  static double pointDistance(const Pose2& map_T_box, const Eigen::Vector2d& half,
                              const Eigen::Vector2d& point) {
    const Eigen::Vector2d p = map_T_box.inverse() * point;
    return (p - p.cwiseMax(-half).cwiseMin(half)).norm();
  }

  static bool cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                    const Eigen::Vector2d& d) {
    const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                         const Eigen::Vector2d& r) {
      return (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x() > 0.0;
    };
    return side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
  }

  Answer test(const PlacedShape& shape, const Pose2& map_T_solid, const Map::Voxel& voxel,
              double floor_m) const {
    const Eigen::Vector3d at = shape.frame_T_shape.translation();
    const Eigen::Matrix3d turn = shape.frame_T_shape.linear();
    const Pose2 map_T_shape =
        map_T_solid * Pose2(at.x(), at.y(), std::atan2(turn(1, 0), turn(0, 0)));
    const Eigen::Vector2d centre = voxel.centre_m.head<2>().cast<double>();
    const double half = voxel.size_m / 2.0;
    const double low = std::max<double>(voxel.centre_m.z() - half, floor_m);
    const double high = voxel.centre_m.z() + half;
    if (high < heightRange(shape).low_m || low > heightRange(shape).high_m) return Answer::kFree;
    double gap = 1.0;
    if (const auto* box = std::get_if<Box>(&shape.shape)) {
      const double vertical =
          std::abs(at.z() - (low + high) / 2) - (high - low + box->size_m.z()) / 2;
      gap = std::max(
          vertical,
          rectangleDistance(map_T_shape, box->size_m.head<2>() / 2.0, centre, half) - margin_m);
    } else if (const auto* cylinder = std::get_if<Cylinder>(&shape.shape)) {
      const double vertical =
          std::abs(at.z() - (low + high) / 2) - (high - low + cylinder->length_m) / 2;
      gap = std::max(vertical, rectangleDistance(map_T_shape, {0, 0}, centre, half) -
                                   cylinder->radius_m - margin_m);
    } else {
      const double radius = std::get<Sphere>(shape.shape).radius_m;
      const double distance = rectangleDistance(map_T_shape, {0, 0}, centre, half);
      for (double z = low; z <= high; z += 0.002) {
        const double off = std::abs(z - at.z());
        if (off >= radius) continue;
        gap = std::min(gap, distance - std::sqrt(radius * radius - off * off) - margin_m);
      }
      if (std::abs(gap) < 3e-3) return Answer::kUnsure;
    }
    if (std::abs(gap) < 1e-5) return Answer::kUnsure;
    return gap < 0 ? Answer::kHit : Answer::kFree;
  }

  /// Over every occupied leaf of the map.
  Answer test(const std::vector<Map::Voxel>& voxels, const Pose2& pose, double floor_m) const {
    bool unsure = false;
    for (const auto& voxel : voxels) {
      if (voxel.centre_m.z() + voxel.size_m / 2.0 <= floor_m + 1e-5) continue;
      const double near = 0.9 + voxel.size_m;
      if ((voxel.centre_m.head<2>().cast<double>() - pose.position()).norm() > near) continue;
      for (const auto& shape : solid) {
        const Answer answer = test(shape, pose, voxel, floor_m);
        if (answer == Answer::kHit) return answer;
        unsure |= answer == Answer::kUnsure;
      }
    }
    return unsure ? Answer::kUnsure : Answer::kFree;
  }
};

Solid mixedSolid() {
  Solid solid = overbedTable();
  solid.push_back({Sphere{0.15}, placed(0.3, -0.2, 0.3), "ball"});
  return solid;
}

TEST(CollisionCheckerTest, agreesWithBruteForceOverEveryLeaf) {
  Random random(1);
  int tested = 0;
  int hits = 0;
  int suspicious = 0;
  for (int scene = 0; scene < 20; ++scene) {
    const double resolution_m = scene % 5 == 4 ? 0.035 : 0.05;
    const Map map = mapOf(randomRoom(&random, 4.0, 9), resolution_m);
    const auto voxels = map.occupied();
    const CollisionChecker checker(map);
    const Reference reference{mixedSolid(), scene % 2 ? 0.0 : random.uniform(0.01, 0.1)};
    const auto footprint = checker.footprint(reference.solid, reference.margin_m);
    for (int i = 0; i < 500; ++i) {
      const Pose2 pose = randomPose(&random, 0.65, 3.35);
      const auto expected = reference.test(voxels, pose, 0.05);
      if (expected == Reference::Answer::kUnsure) continue;
      const bool hit = expected == Reference::Answer::kHit;
      EXPECT_EQ(checker.collides(*footprint, pose), hit)
          << "scene " << scene << ": " << pose.x() << " " << pose.y() << " " << pose.yaw();
      EXPECT_EQ(!checker.contacts(*footprint, pose).empty(), hit);
      const bool mask_hit = checker.maskHits(*footprint, pose);
      EXPECT_TRUE(mask_hit || !hit);
      suspicious += mask_hit && !hit;
      ++tested;
      hits += hit;
    }
  }
  RecordProperty("tested", tested);
  RecordProperty("hits", hits);
  RecordProperty("mask_extra", suspicious);
  std::cout << tested << " tests, " << hits << " hits, mask suspicious but free: " << suspicious
            << "\n";
  EXPECT_GT(tested, 9000);
  EXPECT_GT(hits, 2000);
  EXPECT_LT(hits, 8000);
  EXPECT_LT(suspicious, tested * 12 / 100);
}

WorldModel roomWith(const StaticBox& box) {
  WorldModel world;
  world.min_m = {0, 0};
  world.max_m = {4, 4};
  world.boxes = {box};
  return world;
}

TEST(CollisionCheckerTest, neverMissesTheTipOfALongBar) {
  // Only the bar's corner is in the cell, at the farthest from the origin, where half a heading bin
  // is 4 cm.
  WorldModel world;
  world.min_m = {0, 0};
  world.max_m = {6, 6};
  Map map = mapOf(world, 0.05);
  map.addSurvey({{3.025F, 3.025F, 0.525F}});
  const CollisionChecker checker(map);
  const Solid bar{{Box{{1.6, 0.04, 0.2}}, placed(0.8, 0, 0.5), "bar"}};
  const auto footprint = checker.footprint(bar);
  Random random(13);
  for (int i = 0; i < 20000; ++i) {
    const double yaw = random.uniform(-M_PI, M_PI);
    const Eigen::Vector2d corner(1.6, random.chance(0.5) ? 0.02 : -0.02);
    const Eigen::Vector2d tip(random.uniform(3.0005, 3.0495), random.uniform(3.0005, 3.0495));
    const Eigen::Vector2d origin = tip - Pose2(0, 0, yaw) * corner;
    ASSERT_TRUE(checker.collides(*footprint, {origin.x(), origin.y(), yaw})) << yaw;
  }
}

TEST(CollisionCheckerTest, tableTopPassesAboveALowBox) {
  const Solid table{{Box{{0.8, 0.4, 0.04}}, placed(0, 0, 0.80), "top"},
                    {Cylinder{0.03, 0.8}, placed(-0.35, 0, 0.4), "leg"}};
  const Map low = mapOf(roomWith({"low", {{0.4, 0.4, 0.7}}, placed(2, 2, 0.35)}), 0.05);
  const Map high = mapOf(roomWith({"high", {{0.4, 0.4, 0.9}}, placed(2, 2, 0.45)}), 0.05);
  const CollisionChecker above(low);
  const CollisionChecker against(high);
  EXPECT_FALSE(above.collides(*above.footprint(table), {2.05, 2, 0}));
  EXPECT_TRUE(against.collides(*against.footprint(table), {2.05, 2, 0}));
  EXPECT_TRUE(above.collides(*above.footprint(table), {2.35, 2, 0})) << "its leg is in the box";
}

TEST(CollisionCheckerTest, insideOfACabinetIsOccupied) {
  const Map map = mapOf(roomWith({"cabinet", {{2, 2, 1}}, placed(2, 2, 0.5)}), 0.05);
  const CollisionChecker checker(map);
  const Solid small{{Box{{0.02, 0.02, 0.02}}, placed(0, 0, 0.5), "small"}};
  EXPECT_TRUE(checker.collides(*checker.footprint(small), {2.01, 2.02, 1}));
  EXPECT_FALSE(checker.collides(*checker.footprint(small), {0.5, 0.5, 1}));
}

TEST(CollisionCheckerTest, floorIsNoObstacleAndTallThingsAre) {
  const StaticBox sill{"sill", {{0.3, 0.3, 0.05}}, placed(2, 2, 0.025)};
  const Map map = mapOf(roomWith(sill), 0.05);
  const Solid wheel{{Cylinder{0.1, 0.5}, placed(0, 0, 0.25), "wheel"}};
  const CollisionChecker standing(map, 0.05);
  const CollisionChecker stumbling(map, 0.0);
  EXPECT_FALSE(standing.collides(*standing.footprint(wheel), {2, 2, 0}));
  EXPECT_TRUE(stumbling.collides(*stumbling.footprint(wheel), {2, 2, 0}));
  const StaticBox lamp{"lamp", {{0.3, 0.3, 0.2}}, placed(2, 2, 4.1)};
  const CollisionChecker under_lamp(mapOf(roomWith(lamp), 0.05));
  const Solid mast{{Box{{0.1, 0.1, 4.1}}, placed(0, 0, 2.05), "mast"}};
  const Solid pole{{Box{{0.1, 0.1, 3.9}}, placed(0, 0, 1.95), "pole"}};
  EXPECT_TRUE(under_lamp.collides(*under_lamp.footprint(mast), {2, 2, 0}));
  EXPECT_FALSE(under_lamp.collides(*under_lamp.footprint(pole), {2, 2, 0}))
      << "both are in the last bit of the columns, only the exact test can tell them apart";
}

TEST(CollisionCheckerTest, anyPartOutsideOfTheMapCollides) {
  WorldModel world;
  world.min_m = {0, 0};
  world.max_m = {3, 3};
  const Map map = mapOf(world, 0.05);
  const CollisionChecker checker(map);
  const Solid bar{{Box{{1.0, 0.1, 0.2}}, placed(0.4, 0, 0.5), "bar"}};
  const auto footprint = checker.footprint(bar);
  EXPECT_FALSE(checker.collides(*footprint, {0.11, 1.5, 0}));
  EXPECT_FALSE(checker.collides(*footprint, {2.09, 1.5, 0}));
  EXPECT_TRUE(checker.collides(*footprint, {2.11, 1.5, 0}));
  EXPECT_FALSE(checker.collides(*footprint, {2.5, 1.5, M_PI / 2}));
  EXPECT_TRUE(checker.collides(*footprint, {2.5, 2.5, M_PI / 2}));
  EXPECT_FALSE(checker.collides(*checker.footprint(bar, 0.1), {1.99, 1.5, 0}));
  EXPECT_TRUE(checker.collides(*checker.footprint(bar, 0.1), {2.01, 1.5, 0}));
  EXPECT_TRUE(checker.collides(*footprint, {50.0, -1e9, 0}));
  EXPECT_TRUE(checker.collides(*footprint, {std::nan(""), 1, 0}));
  EXPECT_TRUE(checker.isInside({2.99, 0.01, 0}));
  EXPECT_FALSE(checker.isInside({3.01, 0.01, 0}));
  const auto contacts = checker.contacts(*footprint, {2.15, 1.5, 0});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].with, Contact::With::kOutside);
  EXPECT_NEAR(contacts[0].depth_m, 0.05, 1e-9);
  EXPECT_EQ(describe(contacts[0], {}), "the outside of the map");
}

TEST(CollisionCheckerTest, everythingCollidesInAnEmptyMap) {
  const CollisionChecker checker{Map(0.05)};
  EXPECT_TRUE(checker.collides(*checker.footprint(overbedTable()), {}));
  EXPECT_FALSE(checker.isInside({}));
}

TEST(CollisionCheckerTest, refusesAMapThatIsTooLarge) {
  Map map(0.01);
  map.addSurvey({{0, 0, 0.5F}, {50, 0, 0.5F}});
  try {
    const CollisionChecker checker(map);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "map: extends over 5001 x 1 cells of 0.01 m, at most 4096 x 4096 are allowed");
  }
}

TEST(CollisionCheckerTest, obstaclesAreTestedExactlyWithMargin) {
  WorldModel world;
  world.min_m = {-3, -3};
  world.max_m = {3, 3};
  const Map map = mapOf(world, 0.05);
  CollisionChecker checker(map);
  const Solid post{{Cylinder{0.2, 1.0}, placed(0, 0, 0.5), "post"}};
  checker.setObstacles({{post, {1, 0, 0}, "chair_1"}, {post, {-1, 0, 0}}});
  EXPECT_FALSE(checker.collides(*checker.footprint(post), {0.599, 0, 0}));
  EXPECT_TRUE(checker.collides(*checker.footprint(post), {0.601, 0, 0}));
  EXPECT_TRUE(checker.collides(*checker.footprint(post, 0.05), {0.551, 0, 0}));
  EXPECT_FALSE(checker.collides(*checker.footprint(post, 0.05), {0.549, 0, 0}));
  const auto contacts = checker.contacts(*checker.footprint(post), {0.65, 0, 0});
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].obstacle, 0);
  EXPECT_NEAR(contacts[0].depth_m, 0.05, 1e-12);
  EXPECT_EQ(describe(contacts[0], checker.obstacles()), "chair_1 (post)");
  const CollisionChecker copy(checker);
  checker.setObstacles({});
  EXPECT_FALSE(checker.collides(*checker.footprint(post), {1, 0, 0}));
  EXPECT_TRUE(copy.collides(*copy.footprint(post), {1, 0, 0}));
  EXPECT_EQ(copy.mapColumns(), checker.mapColumns());
}

TEST(CollisionCheckerTest, obstaclesCollideExactlyWhereTheyAreContacts) {
  Random random(5);
  const Map map = mapOf(randomRoom(&random, 4.0, 0), 0.05);
  CollisionChecker checker(map);
  const std::vector<PlacedSolid> placed{{mixedSolid(), randomPose(&random, 1.5, 2.5)},
                                        {overbedTable(), randomPose(&random, 1.5, 2.5)}};
  checker.setObstacles(placed);
  const double margin_m = 0.02;
  const auto footprint = checker.footprint(mixedSolid(), margin_m);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Pose2 pose = randomPose(&random, 0.9, 3.1);
    double depth_m = 0.0;
    for (const PlacedSolid& obstacle : placed) {
      for (const ConvexPart& theirs : convexParts(obstacle.solid)) {
        for (const ConvexPart& ours : convexParts(mixedSolid())) {
          depth_m =
              std::max(depth_m, overlapDepth(ours, pose, theirs, obstacle.map_T_solid, margin_m));
        }
      }
    }
    EXPECT_EQ(checker.collides(*footprint, pose), depth_m > 0.0);
    EXPECT_EQ(checker.contacts(*footprint, pose).empty(), depth_m <= 0.0);
    hits += depth_m > 0.0;
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(hits, 4500);
}

TEST(CollisionCheckerTest, columnsHoldMapAndObstacles) {
  const Map map = mapOf(roomWith({"box", {{0.1, 0.1, 0.2}}, placed(1.05, 1.05, 0.1)}), 0.05);
  CollisionChecker checker(map);
  checker.setObstacles({{{{Box{{0.1, 0.1, 0.1}}, placed(0, 0, 0.55), "b"}}, {3.05, 2.05, 0}}});
  const auto& columns = checker.columns();
  EXPECT_EQ(columns.width, 80);
  EXPECT_EQ(columns.height, 80);
  EXPECT_EQ(columns.bits[20 * 80 + 21], 0b1110U);  // the lowest cell is the floor's
  EXPECT_EQ(columns.bits[41 * 80 + 60], 0b11U << 10);
  EXPECT_EQ(columns.bits[42 * 80 + 60], 0U);
  EXPECT_EQ(checker.mapColumns()->bits[41 * 80 + 60], 0U);
}

TEST(CollisionCheckerTest, prunedAndUnprunedLeavesAreTheSame) {
  Map pruned(0.05);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    points.emplace_back(0.025F + 0.05F * (i % 16), 0.025F + 0.05F * (i / 16 % 16),
                        0.025F + 0.05F * (i / 256));
  }
  pruned.addSurvey(points);
  ASSERT_EQ(pruned.occupied().size(), 1U);
  const CollisionChecker checker(pruned);
  const auto& columns = checker.columns();
  ASSERT_EQ(columns.bits.size(), 256U);
  for (const std::uint64_t bits : columns.bits) EXPECT_EQ(bits, 0xfffeU);
}

}  // namespace
}  // namespace casepush
