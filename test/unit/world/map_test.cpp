#include "casepush/world/map.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "casepush/common/input_error.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

namespace fs = std::filesystem;

class MapTest : public ::testing::Test {
 protected:
  MapTest() : folder_(fs::temp_directory_path() / ("casepush_map_test_" + name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MapTest() override { fs::remove_all(folder_); }

  static std::string name() {
    return ::testing::UnitTest::GetInstance()->current_test_info()->name();
  }
  fs::path write(const std::string& file, const std::string& content) const {
    std::ofstream(folder_ / file, std::ios::binary) << content;
    return folder_ / file;
  }
  static std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  fs::path folder_;
};

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

void expectError(const std::function<void()>& action, const std::string& text) {
  EXPECT_NE(errorOf(action).find(text), std::string::npos) << errorOf(action) << "\n" << text;
}

/// Unit cells (by index) that a map's voxels cover.
std::set<std::array<int, 3>> cells(const Map& map) {
  std::set<std::array<int, 3>> result;
  for (const auto& voxel : map.occupied()) {
    const Eigen::Vector3d corner =
        (voxel.centre_m.cast<double>().array() - voxel.size_m / 2.0) / map.resolution();
    const int size = static_cast<int>(std::lround(voxel.size_m / map.resolution()));
    for (int i = 0; i < size * size * size; ++i) {
      result.insert({static_cast<int>(std::lround(corner.x())) + i % size,
                     static_cast<int>(std::lround(corner.y())) + i / size % size,
                     static_cast<int>(std::lround(corner.z())) + i / size / size});
    }
  }
  return result;
}

Map exampleMap() {
  Random random(7);
  return mapOf(randomRoom(&random, 3.0, 6), 0.05);
}

TEST_F(MapTest, keepsItsCellsThroughFilesAndMessages) {
  const Map map = exampleMap();
  const auto expected = cells(map);
  ASSERT_GT(expected.size(), 1000U);
  map.save(folder_ / "room.bt");
  EXPECT_EQ(cells(Map::load(folder_ / "room.bt")), expected);
  EXPECT_EQ(cells(Map::fromBinary(map.resolution(), map.toBinary())), expected);
  ASSERT_TRUE(map.tree().write((folder_ / "room.ot").string()));
  EXPECT_EQ(cells(Map::load(folder_ / "room.ot")), expected);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2) << "a draft was left behind";
}

TEST_F(MapTest, keepsFreeSpaceAndBoundsThroughFiles) {
  Map map(0.1);
  map.addScan({0.05F, 0.05F, 0.55F}, {{2.05F, 0.05F, 0.55F}}, 10.0);
  map.save(folder_ / "scan.bt");
  const Map loaded = Map::load(folder_ / "scan.bt");
  EXPECT_NEAR((loaded.min() - Eigen::Vector3d(0.0, 0.0, 0.5)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((loaded.max() - Eigen::Vector3d(2.1, 0.1, 0.6)).norm(), 0.0, 1e-9);
  EXPECT_EQ(cells(loaded), (std::set<std::array<int, 3>>{{20, 0, 5}}));
}

TEST_F(MapTest, refusesEveryTruncation) {
  const Map map = exampleMap();
  map.save(folder_ / "room.bt");
  ASSERT_TRUE(map.tree().write((folder_ / "room.ot").string()));
  for (const char* file : {"room.bt", "room.ot"}) {
    const std::string whole = read(folder_ / file);
    for (std::size_t length = 1; length < whole.size(); length += 1 + whole.size() / 97) {
      const fs::path cut = write(std::string("cut_") + file, whole.substr(0, length));
      EXPECT_THROW(Map::load(cut), InputError) << file << " cut to " << length;
    }
    expectError([&] { Map::load(write("last", whole.substr(0, whole.size() - 1))); },
                "last: is truncated: the octree's data end early");
  }
  auto bytes = map.toBinary();
  bytes.pop_back();
  expectError([&] { Map::fromBinary(0.05, bytes); }, "octomap message: is truncated");
}

TEST_F(MapTest, refusesFilesThatAreNoMap) {
  const std::string head = "# Octomap OcTree binary file\n";
  expectError([&] { Map::load(folder_ / "none.bt"); }, "none.bt: there is no such map file");
  expectError([&] { Map::load(folder_); }, "there is no such map file");
  expectError([&] { Map::load(write("a.bt", "")); }, "a.bt: is empty, must be an OctoMap");
  expectError([&] { Map::load(write("a.bt", "P5 640 480\n")); }, "a.bt: is no OctoMap file");
  expectError([&] { Map::load(write("a.bt", head + "id OcTree\nsize 1\nres 0.05\n")); },
              "a.bt: is truncated: its header has no line \"data\"");
  expectError([&] { Map::load(write("a.bt", head + "id ColorOcTree\nsize 1\nres 0.05\ndata\n")); },
              "a.bt: holds a tree of type \"ColorOcTree\", must be OcTree");
  expectError([&] { Map::load(write("a.bt", head + "id OcTree\nsize 1\nres 0.7\ndata\n")); },
              "a.bt: resolution is 0.7 m, must be in [0.01, 0.5] m");
  expectError([&] { Map::load(write("a.bt", head + "id OcTree\nsize 1\nres nan\ndata\n")); },
              "resolution is");
  expectError([&] { Map::load(write("a.bt", head + "id OcTree\nsize x\nres 0.1\ndata\n")); },
              "a.bt: is damaged: its header has no valid line \"size\"");
  expectError([&] { Map::load(write("a.bt", head + "id OcTree\nsize 0\nres 0.05\ndata\n")); },
              "a.bt: holds an empty map");
}

TEST_F(MapTest, refusesDamagedOctrees) {
  const std::string head = "# Octomap OcTree binary file\nid OcTree\nsize 3\nres 0.05\ndata\n";
  expectError([&] { Map::load(write("a.bt", head + std::string(64, '\xff'))); },
              "a.bt: is damaged: the octree is nested deeper than 16 levels");
  expectError([&] { Map::load(write("a.bt", head + std::string("\x01\x00", 2))); },
              "a.bt: is damaged: it holds 2 nodes, its header says 3");
  auto bytes = exampleMap().toBinary();
  bytes.push_back(0);
  expectError([&] { Map::fromBinary(0.05, bytes); }, "octomap message: is damaged");
  expectError([&] { Map::fromBinary(0.0, bytes); }, "octomap message: resolution is 0 m");
}

TEST_F(MapTest, survivesRandomDamage) {
  const Map map = exampleMap();
  const auto whole = map.toBinary();
  Random random(3);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    auto bytes = whole;
    for (int k = 0; k < 3; ++k) bytes[random.below(bytes.size())] ^= 1 << random.below(8);
    try {
      Map::fromBinary(0.05, bytes);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(MapTest, leavesAnOlderFileWhenItCannotWrite) {
  expectError([&] { exampleMap().save(folder_ / "no_such_folder" / "a.bt"); },
              "a.bt: cannot be written: No such file");
  fs::create_directories(folder_ / "taken.bt");
  write("taken.bt/file", "x");
  expectError([&] { exampleMap().save(folder_ / "taken.bt"); },
              "cannot be written: Is a directory");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(MapTest, refusesPointsAndResolutionsThatMakeNoSense) {
  Map map(0.05);
  const float nan = std::nanf("");
  expectError([&] { map.addSurvey({{1, 1, 1}, {nan, 0, 0}}); }, "map survey: point (nan, 0, 0)");
  EXPECT_TRUE(map.empty());
  expectError([&] { map.addSurvey({{9000, 0, 0}}); }, "too far away");
  expectError([&] { map.addScan({nan, 0, 0}, {}, 1.0); }, "map scan: origin (nan, 0, 0)");
  expectError([&] { map.addScan({0, 0, 0}, {}, 0.0); }, "map scan: range is 0");
  expectError([] { Map(0.001); }, "map: resolution is 0.001 m, must be in [0.01, 0.5] m");
  map.addScan({0, 0, 0.5F}, {{nan, 0, 0}, {1.01F, 0.01F, 0.51F}}, 5.0);
  EXPECT_EQ(map.occupied().size(), 1U);
}

TEST(SurveyPointsTest, fillsBoxesCompletelyAndNothingElse) {
  WorldModel world;
  world.min_m = {-1.0, -1.0};
  world.max_m = {2.0, 2.0};
  world.boxes = {{"cabinet", {{0.5, 0.4, 0.6}}, placed(0.25, 0.2, 0.3)}};
  const Map map = mapOf(world, 0.1);
  std::set<std::array<int, 3>> standing;
  for (const auto& cell : cells(map)) {
    if (cell[2] >= 0) standing.insert(cell);
  }
  EXPECT_EQ(standing.size(), 5U * 4U * 6U);
  EXPECT_TRUE(standing.count({2, 2, 3})) << "the inside is empty";
  EXPECT_NEAR((map.min() - Eigen::Vector3d(-1, -1, -0.1)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((map.max() - Eigen::Vector3d(2, 2, 0.6)).norm(), 0.0, 1e-9);
}

std::string surveyError(const StaticBox& box, double resolution_m) {
  WorldModel world;
  world.name = "hall";
  world.boxes = {box};
  return errorOf([&] { surveyPoints(world, resolution_m); });
}

TEST(SurveyPointsTest, refusesWorldsThatAreTooLarge) {
  EXPECT_EQ(surveyError({"cube", {{1000, 1000, 1000}}, placed(0, 0, 500)}, 0.05),
            "world 'hall': is too large to be surveyed at 0.05 m: it spans 20000 cells; must be at "
            "most 4096");
  EXPECT_EQ(
      surveyError({"cube", {{100, 100, 100}}, placed(0, 0, 50)}, 0.1)
          .find("world 'hall': is too large to be surveyed at 0.1 m: its boxes fill up to 1.0"),
      0U);
  StaticBox wall{"wall", {{140, 0.1, 100}}, placed(0, 0, 50)};
  wall.map_T_box.rotate(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(
      surveyError(wall, 0.05)
          .find("world 'hall': is too large to be surveyed at 0.05 m: around its boxes lie 7.87"),
      0U)
      << surveyError(wall, 0.05);
  EXPECT_NE(surveyError({"far", {{1, 1, 1}}, placed(1e300, 0, 0)}, 0.05).find("it spans"),
            std::string::npos);
  WorldModel remote;
  remote.min_m = {1e6, 1e6};
  remote.max_m = {1e6 + 5.0, 1e6 + 5.0};
  expectError([&] { surveyPoints(remote, 0.05); },
              "it reaches 1e+06 m away from the origin; must be at most 1638.35 m");
}

TEST(SurveyPointsTest, coversEveryPointOfTurnedBoxes) {
  Random random(11);
  for (int round = 0; round < 5; ++round) {
    const WorldModel world = randomRoom(&random, 3.0, 8);
    const auto covered = cells(mapOf(world, 0.05));
    for (const StaticBox& box : world.boxes) {
      const Eigen::Vector3d inside = box.box.size_m.array() / 2.0 - 0.0021;
      for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d unit(random.uniform(-1, 1), random.uniform(-1, 1),
                                   random.uniform(-1, 1));
        const Eigen::Vector3d point = box.map_T_box * inside.cwiseProduct(unit);
        if (point.z() < 0.0) continue;
        const Eigen::Vector3d cell = point / 0.05;
        EXPECT_TRUE(covered.count({static_cast<int>(std::floor(cell.x())),
                                   static_cast<int>(std::floor(cell.y())),
                                   static_cast<int>(std::floor(cell.z()))}))
            << point.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace casepush
