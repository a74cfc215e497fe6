#include "casepush/world/occupancy_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "casepush/common/input_error.h"
#include "casepush/common/scratch_folder.h"
#include "casepush/world/collision_checker.h"
#include "casepush/world/map_file.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// 4 m x 3 m with walls around, one cell thick, and an unknown patch.
OccupancyGrid plan(double resolution_m) {
  OccupancyGrid grid;
  grid.resolution_m = resolution_m;
  grid.width = static_cast<int>(std::lround(4.0 / resolution_m));
  grid.height = static_cast<int>(std::lround(3.0 / resolution_m));
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const bool rim = x == 0 || y == 0 || x == grid.width - 1 || y == grid.height - 1;
      const bool unknown = x * resolution_m > 3.0 && y * resolution_m > 2.0;
      grid.cells.push_back(static_cast<std::int8_t>(rim ? 100 : unknown ? -1 : 0));
    }
  }
  return grid;
}

/// Tells where a thin post collides with a map.
class Post {
 public:
  explicit Post(const Map& map, double low_m = 0.1, double high_m = 0.5)
      : checker_(map),
        footprint_(checker_.footprint(
            {{Cylinder{0.05, high_m - low_m}, placed(0.0, 0.0, (low_m + high_m) / 2.0), "post"}})) {
  }

  bool collidesAt(const Eigen::Vector2d& place) const {
    return checker_.collides(*footprint_, Pose2(place.x(), place.y(), 0.0));
  }

 private:
  CollisionChecker checker_;
  std::shared_ptr<const Footprint> footprint_;
};

TEST(OccupancyGridTest, makesWallsOfTheGivenHeightAtEveryResolution) {
  for (const double resolution_m : {0.02, 0.05, 0.1, 0.2}) {
    for (const double grid_resolution_m : {0.05, 0.1}) {
      OccupancyOptions options;
      options.height_m = 1.0;
      const Map map = mapOf(plan(grid_resolution_m), options, resolution_m, "plan");
      const Post post(map);
      EXPECT_TRUE(post.collidesAt({0.03, 1.5}));
      EXPECT_TRUE(post.collidesAt({2.0, 2.97}));
      EXPECT_FALSE(post.collidesAt({2.0, 1.5}));
      EXPECT_FALSE(post.collidesAt({3.3, 2.3})) << "unknown is free";
      EXPECT_FALSE(Post(map, 1.01, 1.2).collidesAt({0.1, 1.5})) << "above the wall";
      EXPECT_TRUE(CollisionChecker(map).isInside(Pose2(3.99, 2.99, 0.0)));
      EXPECT_FALSE(CollisionChecker(map).isInside(Pose2(4.0 + 1.1 * resolution_m, 1.0, 0.0)));
    }
  }
}

TEST(OccupancyGridTest, takesUnknownSpaceForWallsIfAsked) {
  OccupancyOptions options;
  options.unknown_is_wall = true;
  const Map map = mapOf(plan(0.05), options, 0.05, "plan");
  EXPECT_TRUE(Post(map).collidesAt({3.3, 2.3}));
  EXPECT_FALSE(Post(map).collidesAt({2.0, 1.5}));
}

TEST(OccupancyGridTest, placesTurnedGrids) {
  OccupancyGrid grid = plan(0.05);
  grid.map_T_grid = Pose2(1.0, -2.0, 0.5);
  const Post post(mapOf(grid, {}, 0.05, "plan"));
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d point(random.uniform(0.3, 3.7), random.uniform(0.3, 2.7));
    EXPECT_FALSE(post.collidesAt(grid.map_T_grid * point)) << point.transpose();
    const double along_m = random.uniform(0.0, 3.0);
    EXPECT_TRUE(post.collidesAt(grid.map_T_grid * Eigen::Vector2d(0.02, along_m))) << along_m;
    EXPECT_TRUE(post.collidesAt(grid.map_T_grid * Eigen::Vector2d(4.03, along_m)))
        << "open at its end";
  }
}

TEST(OccupancyGridTest, countsCellsFromTheThreshold) {
  OccupancyGrid grid = plan(0.05);
  grid.cells[30 * grid.width + 40] = 60;
  const Eigen::Vector2d there(40.5 * 0.05, 30.5 * 0.05);
  OccupancyOptions options;
  EXPECT_FALSE(Post(mapOf(grid, options, 0.05, "plan")).collidesAt(there));
  options.occupied_from = 60;
  EXPECT_TRUE(Post(mapOf(grid, options, 0.05, "plan")).collidesAt(there));
}

TEST(OccupancyGridTest, refusesGridsThatMakeNoSense) {
  const auto error = [](const std::function<void(OccupancyGrid&)>& spoil) {
    OccupancyGrid grid = plan(0.05);
    spoil(grid);
    return errorOf([&] { mapOf(grid, {}, 0.05, "plan"); });
  };
  EXPECT_EQ(error([](auto& grid) { grid.resolution_m = 0.0; }),
            "plan: resolution is 0 m, must be in [0.001, 10] m");
  EXPECT_NE(error([](auto& grid) { grid.resolution_m = std::nan(""); }).find("resolution is nan"),
            std::string::npos);
  EXPECT_EQ(error([](auto& grid) { grid.width = 0; }),
            "plan: has 0 x 60 cells, must have 1 to 16384 each way");
  EXPECT_EQ(error([](auto& grid) { grid.cells.pop_back(); }),
            "plan: holds 4799 cells, its size says 4800");
  EXPECT_NE(error([](auto& grid) { grid.resolution_m = 5.0; }).find("more than 4096 cells"),
            std::string::npos);
  EXPECT_EQ(errorOf([] { mapOf(plan(0.05), {}, 0.0, "plan"); }),
            "plan: resolution is 0 m, must be in [0.01, 0.5] m");
}

class OccupancyFileTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
    return folder_.path() / name;
  }
  std::filesystem::path writePlan(const std::string& extra, const std::string& image) const {
    write("plan.pgm", image);
    return write("plan.yaml",
                 "image: plan.pgm\nresolution: 0.1\norigin: [1.0, 2.0, 0.0]\n" + extra);
  }

  ScratchFolder folder_;
};

const std::string kImage = std::string("P5\n# made by hand\n3 2\n255\n") + '\x00' + '\xcd' +
                           '\xfe' + '\xfe' + '\xfe' + '\x00';

TEST_F(OccupancyFileTest, readsWhatMapServerWrites) {
  const OccupancyGrid grid = loadOccupancyGrid(
      writePlan("negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n", kImage));
  EXPECT_EQ(grid.width, 3);
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.map_T_grid.y(), 2.0);
  // The image's last row is the grid's first.
  EXPECT_EQ(grid.cells, (std::vector<std::int8_t>{0, 0, 100, 100, -1, 0}));
  const OccupancyGrid ascii = loadOccupancyGrid(writePlan("", "P2 3 2 255\n0 205 254 254 254 0"));
  EXPECT_EQ(ascii.cells, grid.cells);
  const OccupancyGrid negated = loadOccupancyGrid(writePlan("negate: 1\n", kImage));
  EXPECT_EQ(negated.cells, (std::vector<std::int8_t>{100, 100, 0, 0, 100, 100}));
  const OccupancyGrid scaled = loadOccupancyGrid(writePlan("mode: scale\n", kImage));
  EXPECT_EQ(scaled.cells[3], 100);
  EXPECT_EQ(scaled.cells[4], 1);
}

TEST_F(OccupancyFileTest, becomesAMapLikeAnyOther) {
  const Map map = loadMap(writePlan("", kImage));
  EXPECT_EQ(map.resolution(), 0.05);
  EXPECT_NEAR((map.min().head<2>() - Eigen::Vector2d(1.0, 2.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((map.max() - Eigen::Vector3d(1.3, 2.2, 1.5)).norm(), 0.0, 1e-9);
  map.save(folder_.path() / "plan.bt");
  MapFileOptions coarse;
  coarse.resolution_m = 0.1;
  const Map again = loadMap(folder_.path() / "plan.bt", coarse);
  EXPECT_EQ(again.resolution(), 0.1);
  EXPECT_EQ(again.max(), map.max());
  EXPECT_NEAR(sizeOf(again).occupied_m3, 2 * 15 * 0.001 + 6 * 0.001, 1e-9) << "two posts and a rim";
}

TEST_F(OccupancyFileTest, refusesDamage) {
  const auto error = [&](const std::string& extra, const std::string& image) {
    return errorOf([&] { loadOccupancyGrid(writePlan(extra, image)); });
  };
  const auto expect = [](const std::string& found, const std::string& text) {
    EXPECT_NE(found.find(text), std::string::npos) << found;
  };
  expect(error("", kImage.substr(0, kImage.size() - 1)), "plan.pgm: is truncated");
  expect(error("", "P5 3"), "plan.pgm: is truncated or damaged");
  expect(error("", "\x89PNG"), "plan.pgm: is no grey image of type PGM (P2 or P5)");
  expect(error("", "P5 3 0 255 "), "plan.pgm: is damaged: it has 0 where 1 to 16384 is expected");
  expect(error("mode: strange\n", kImage), "is 'strange', must be trinary, scale or raw");
  expect(error("colour: red\n", kImage), "colour");
  expect(error("free_thresh: 0.9\n", kImage), "is greater than occupied_thresh");
  writePlan("", kImage);
  std::filesystem::remove(folder_.path() / "plan.pgm");
  expect(errorOf([&] { loadOccupancyGrid(folder_.path() / "plan.yaml"); }),
         "plan.pgm: there is no such image file");
  expect(errorOf([&] { loadMap(folder_.path() / "none.bt"); }), "there is no such map file");
}

TEST(ResampledMap, coversWhatItCovered) {
  Random random(9);
  const Map fine = mapOf(randomRoom(&random, 3.0, 6), 0.05);
  for (const double resolution_m : {0.02, 0.1, 0.2}) {
    const Map other = resampled(fine, resolution_m);
    const CollisionChecker before(fine);
    const CollisionChecker after(other);
    const auto table_before = before.footprint(overbedTable());
    const auto table_after = after.footprint(overbedTable());
    for (int i = 0; i < 200; ++i) {
      const Pose2 pose = randomPose(&random, 0.0, 3.0);
      EXPECT_TRUE(after.collides(*table_after, pose) || !before.collides(*table_before, pose));
    }
  }
}

}  // namespace
}  // namespace casepush
