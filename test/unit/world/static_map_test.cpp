#include "casepush/world/static_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <set>

#include "casepush/common/random.h"
#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

constexpr double kCell_m = 0.05;

using Cells = std::multiset<std::array<int, 3>>;

/// Every cell that a box fills, once for each box.
Cells cellsOf(const std::vector<StaticBox>& boxes) {
  Cells cells;
  for (const StaticBox& box : boxes) {
    const Eigen::Vector3d corner = box.map_T_box.translation() - 0.5 * box.box.size_m;
    const Eigen::Array3i low = (corner / kCell_m).array().round().cast<int>();
    const Eigen::Array3i count = (box.box.size_m / kCell_m).array().round().cast<int>();
    EXPECT_LT((corner / kCell_m - low.cast<double>().matrix()).norm(), 1e-3) << box.name;
    for (int x = 0; x < count.x(); ++x) {
      for (int y = 0; y < count.y(); ++y) {
        for (int z = 0; z < count.z(); ++z) {
          cells.insert({low.x() + x, low.y() + y, low.z() + z});
        }
      }
    }
  }
  return cells;
}

Map surveyOf(const WorldModel& world) {
  Map map(kCell_m);
  map.addSurvey(surveyPoints(world, kCell_m));
  return map;
}

/// Every cell of a map above the floor.
Cells cellsOf(const Map& map, double floor_m) {
  Cells cells;
  for (const Map::Voxel& voxel : map.occupied()) {
    StaticBox box;
    box.box.size_m.setConstant(static_cast<double>(voxel.size_m));
    box.map_T_box.translation() = voxel.centre_m.cast<double>();
    cells.merge(cellsOf(std::vector<StaticBox>{box}));
  }
  for (auto cell = cells.begin(); cell != cells.end();) {
    cell = ((*cell)[2] + 1) * kCell_m <= floor_m + 1e-6 ? cells.erase(cell) : std::next(cell);
  }
  return cells;
}

std::vector<StaticBox> boxesOfWhole(const Map& map, double floor_m = kCell_m) {
  return boxesOf(map, {-100.0, -100.0}, {100.0, 100.0}, "map", floor_m);
}

TEST(BoxesOf, fillTheOccupiedCellsExactlyAndOnce) {
  Random random(3);
  for (int round = 0; round < 5; ++round) {
    const Map map = surveyOf(randomRoom(&random, 3.0, 8));
    EXPECT_EQ(cellsOf(boxesOfWhole(map)), cellsOf(map, kCell_m));
    EXPECT_EQ(cellsOf(boxesOfWhole(map, 0.3)), cellsOf(map, 0.3));
  }
}

TEST(BoxesOf, makeOneBoxOfACuboid) {
  WorldModel world;
  world.boxes.push_back({"cabinet", {{0.5, 0.4, 0.6}}, Eigen::Isometry3d::Identity()});
  world.boxes[0].map_T_box.translation() << 0.25, -0.2, 0.3;
  const std::vector<StaticBox> boxes = boxesOfWhole(surveyOf(world), 0.0);
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_EQ(boxes[0].name, "map_1");
  EXPECT_LT((boxes[0].box.size_m - Eigen::Vector3d(0.5, 0.4, 0.6)).norm(), 1e-9);
  EXPECT_LT((boxes[0].map_T_box.translation() - Eigen::Vector3d(0.25, -0.2, 0.3)).norm(), 1e-9);
}

TEST(BoxesOf, areFewForAFurnishedRoom) {
  const WorldModel office = loadWorld(Catalog::standard(), "office");
  const Map map = surveyOf(office);
  const std::size_t boxes = boxesOfWhole(map).size();
  EXPECT_LT(boxes, 3 * office.boxes.size());
  EXPECT_GT(map.occupied().size(), 50 * boxes);
}

TEST(BoxesOf, keepWithinTheBounds) {
  const Map map = surveyOf(loadWorld(Catalog::standard(), "office"));
  const Eigen::Vector2d min_m(1.0, 2.0);
  const Eigen::Vector2d max_m(9.0, 8.0);
  const std::vector<StaticBox> boxes = boxesOf(map, min_m, max_m, "map");
  ASSERT_FALSE(boxes.empty());
  for (const StaticBox& box : boxes) {
    const Eigen::Vector2d centre = box.map_T_box.translation().head<2>();
    const Eigen::Vector2d half = 0.5 * box.box.size_m.head<2>();
    EXPECT_GE((centre - half - min_m).minCoeff(), -0.5 * kCell_m) << box.name;
    EXPECT_GE((max_m - centre - half).minCoeff(), -0.5 * kCell_m) << box.name;
  }
}

class StaticMap : public testing::Test {
 protected:
  /// A world whose walls and furniture are in a map file beside it.
  std::filesystem::path writeWorld(const std::string& map_name, const std::string& boxes = "") {
    return folder_.write("room.yaml",
                         "bounds: {min: [0, 0], max: [15, 15]}\nstatic_map: " + map_name +
                             "\nrobot: {model: cobot, xy: [2.4, 3.8], yaw_deg: 0}\n" + boxes);
  }

  std::string errorOf(const std::filesystem::path& world) {
    const std::string text = inputErrorText([&] { loadWorld(catalog_, world.string()); });
    const std::string prefix = folder_.path().string() + "/";
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
  }

  const TemporaryFolder folder_;
  const Catalog catalog_ = Catalog::standard();
};

TEST_F(StaticMap, isPartOfTheWorldAndOfItsSurvey) {
  const Map map = surveyOf(loadWorld(catalog_, "office"));
  map.save(folder_.path() / "office.bt");
  const WorldModel world = loadWorld(catalog_, writeWorld("office.bt").string());
  EXPECT_FALSE(world.static_map);
  EXPECT_FALSE(world.boxes.empty());
  EXPECT_EQ(cellsOf(surveyOf(world), kCell_m), cellsOf(map, kCell_m));
}

TEST_F(StaticMap, joinsTheBoxesOfTheWorld) {
  surveyOf(loadWorld(catalog_, "office")).save(folder_.path() / "office.bt");
  const std::string boxes = "boxes:\n  - {name: crate, size_m: [1, 1, 1], xyz: [5, 9, 0.5]}\n";
  const WorldModel world = loadWorld(catalog_, writeWorld("office.bt", boxes).string());
  EXPECT_EQ(world.boxes.front().name, "crate");
  EXPECT_EQ(world.boxes[1].name, "static_map_1");
  const std::string taken =
      "boxes:\n  - {name: static_map_1, size_m: [1, 1, 1], xyz: [5, 9, 0.5]}\n";
  EXPECT_EQ(errorOf(writeWorld("office.bt", taken)),
            "world room: names like 'static_map_1' are taken by its static map; rename the others");
}

TEST_F(StaticMap, refusesFilesThatAreMissingDamagedOrElsewhere) {
  EXPECT_EQ(errorOf(writeWorld("absent.bt")), "absent.bt: there is no such map file");
  EXPECT_EQ(errorOf(writeWorld("office.stl")),
            "room.yaml: static_map: is 'office.stl'; must be an OctoMap file, .bt or .ot");

  surveyOf(loadWorld(catalog_, "office")).save(folder_.path() / "office.bt");
  std::filesystem::resize_file(folder_.path() / "office.bt",
                               std::filesystem::file_size(folder_.path() / "office.bt") / 2);
  EXPECT_EQ(errorOf(writeWorld("office.bt")),
            "office.bt: is truncated: the octree's data end early");

  Map elsewhere(kCell_m);
  elsewhere.addSurvey({{100.0F, 100.0F, 1.0F}});
  elsewhere.save(folder_.path() / "elsewhere.bt");
  EXPECT_EQ(errorOf(writeWorld("elsewhere.bt")),
            "elsewhere.bt: holds nothing above the floor within the bounds of world room; is it in "
            "the same frame?");

  Map sparse(0.01);
  sparse.addSurvey({{0.1F, 0.1F, 0.1F}, {14.9F, 14.9F, 300.0F}});
  sparse.save(folder_.path() / "sparse.bt");
  EXPECT_NE(errorOf(writeWorld("sparse.bt")).find("use a coarser map"), std::string::npos);
}

}  // namespace
}  // namespace casepush
