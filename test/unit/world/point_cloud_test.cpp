#include "casepush/world/point_cloud.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "casepush/world/static_map.h"
#include "common/input_error_text.h"
#include "common/temporary_folder.h"

namespace casepush {
namespace {

std::string header(const std::string& points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS intensity x y z\n"
         "SIZE 1 4 4 8\nTYPE U F F F\nCOUNT 2 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

std::string binary(float x, float y, double z) {
  std::string bytes(2 + 4 + 4 + 8, '\0');
  std::memcpy(&bytes[2], &x, 4);
  std::memcpy(&bytes[6], &y, 4);
  std::memcpy(&bytes[10], &z, 8);
  return bytes;
}

class LoadPointCloud : public testing::Test {
 protected:
  std::vector<Eigen::Vector3f> load(const std::string& name, const std::string& text) {
    return loadPointCloud(folder_.write(name, text));
  }

  /// What is said after the file's name.
  std::string errorOf(const std::string& name, const std::string& text) {
    const std::string error = inputErrorText([&] { load(name, text); });
    const std::string prefix = (folder_.path() / name).string() + ": ";
    EXPECT_EQ(error.rfind(prefix, 0), 0U) << error;
    return error.substr(std::min(prefix.size(), error.size()));
  }

  const TemporaryFolder folder_;
  const std::vector<Eigen::Vector3f> two_{{1.0F, -2.5F, 0.25F}, {3.0F, 4.0F, 1e-3F}};
};

TEST_F(LoadPointCloud, readsAllFormats) {
  EXPECT_EQ(load("a.pcd", header("2", "ascii") + "7 8 1 -2.5 0.25\n7 8 3 4 1e-3\n"), two_);
  EXPECT_EQ(load("b.pcd", header("2", "binary") + binary(1, -2.5F, 0.25) + binary(3, 4, 1e-3)),
            two_);
  EXPECT_EQ(load("c.xyz", "# x y z intensity\n1 -2.5 0.25 99\r\n\n 3,4,1e-3"), two_);
}

TEST_F(LoadPointCloud, refusesTruncatedFiles) {
  const std::string ascii = header("2", "ascii") + "7 8 1 -2.5 0.25\n";
  EXPECT_EQ(errorOf("a.pcd", ascii), "is truncated: it holds 1 of 2 points");
  EXPECT_EQ(errorOf("a.pcd", ascii + "7 8 3 4"), "line 13 holds 4 numbers, must hold at least 5");
  const std::string whole = header("2", "binary") + binary(1, 2, 3) + binary(1, 2, 3);
  EXPECT_EQ(errorOf("b.pcd", whole.substr(0, whole.size() - 1)),
            "is truncated: it holds 1 of 2 points");
  EXPECT_EQ(errorOf("b.pcd", whole.substr(0, 60)),
            "is no .pcd file or truncated: its header has no line DATA");
  EXPECT_EQ(errorOf("c.xyz", "1 2 3\n4 5"), "line 2 holds 2 numbers, must hold at least 3");
}

TEST_F(LoadPointCloud, refusesPointsThatAreNotFinite) {
  const std::string advice =
      " is not finite; remove such points, which often stand for missing "
      "returns";
  EXPECT_EQ(errorOf("a.pcd", header("1", "ascii") + "7 8 1 nan 3\n"), "line 12" + advice);
  EXPECT_EQ(errorOf("b.pcd", header("2", "binary") + binary(1, 2, 3) +
                                 binary(1, std::numeric_limits<float>::infinity(), 3)),
            "point 2" + advice);
  EXPECT_EQ(errorOf("c.xyz", "1 2 3\n1 2 1e60\n"), "line 2" + advice);
}

TEST_F(LoadPointCloud, refusesEmptyAndGiantFiles) {
  EXPECT_EQ(errorOf("a.pcd", ""), "is no .pcd file or truncated: its header has no line DATA");
  EXPECT_EQ(errorOf("a.pcd", header("0", "ascii")), "holds no points");
  EXPECT_EQ(errorOf("b.pcd", header("0", "binary")), "holds no points");
  EXPECT_EQ(errorOf("c.xyz", "# nothing\n"), "holds no points");
  for (const char* data : {"ascii", "binary"}) {
    EXPECT_EQ(errorOf("a.pcd", header("4000000000", data)),
              "holds 4000000000 points or more; must be at most 20000000: thin it out first");
  }
  EXPECT_EQ(errorOf("c.xyz", std::string(20000, '1')), "line 1 is no text");
  EXPECT_EQ(errorOf("c.xyz", std::string("1 2 3\n\0\0", 8)), "line 2 is no text");
}

TEST_F(LoadPointCloud, refusesWhatItCannotRead) {
  EXPECT_EQ(errorOf("c.xyz", "1 2 three\n"), "line 1: 'three' is no number");
  EXPECT_EQ(errorOf("a.pcd", header("1", "binary_compressed")),
            "has DATA 'binary_compressed'; must be ascii or binary (pcl_convert_pcd_ascii_binary "
            "converts)");
  EXPECT_EQ(errorOf("a.pcd", header("two", "ascii")),
            "is damaged: POINTS holds 'two', no valid number");
  EXPECT_EQ(errorOf("a.pcd", header("1", "ascii") + "1 2 3 4 5\n1 2 3 4 5\n"),
            "is damaged: it holds 2 points, its header says 1");
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string good = header("1", "ascii") + "7 8 1 2 3\n";
  EXPECT_EQ(errorOf("a.pcd", changed(good, "intensity x y z", "intensity x y t")),
            "lacks a field x, y or z");
  EXPECT_EQ(errorOf("a.pcd", changed(good, "TYPE U F F F", "TYPE U I F F")),
            "has a field x that is neither float nor double");
  EXPECT_EQ(errorOf("a.pcd", changed(good, "SIZE 1 4 4 8", "SIZE 1 4 4")),
            "is damaged: SIZE has 3 entries for 4 fields");
  EXPECT_EQ(errorOf("a.pcd", changed(good, "COUNT 2", "COUNT 70000")),
            "is damaged: a point of it would take more than 65536 bytes");
  EXPECT_EQ(errorOf("a.pcd", changed(good, "HEIGHT 1", "HEIGHT 2")),
            "is damaged: WIDTH times HEIGHT differs from POINTS");
  EXPECT_EQ(inputErrorText([&] { loadPointCloud(folder_.path()); }),
            folder_.path().string() + ": is no regular file");
  EXPECT_EQ(inputErrorText([&] { loadPointCloud("nowhere.pcd"); }),
            "nowhere.pcd: there is no such file");
}

class PointCloudWorld : public testing::Test {
 protected:
  WorldModel load(const std::string& cloud, const std::string& key) {
    folder_.write("scan.xyz", cloud);
    return loadWorld(catalog_,
                     folder_
                         .write("room.yaml", "bounds: {min: [0, 0], max: [8, 8]}\n" + key +
                                                 "robot: {model: cobot, xy: [2, 4], "
                                                 "yaw_deg: 0}\n")
                         .string());
  }
  std::string errorOf(const std::string& cloud, const std::string& key) {
    const std::string error = inputErrorText([&] { load(cloud, key); });
    return error.substr(
        error.find(folder_.path().string()) == 0 ? folder_.path().string().size() + 1 : 0);
  }

  const TemporaryFolder folder_;
  const Catalog catalog_ = Catalog::standard();
};

TEST_F(PointCloudWorld, isMadeOfTheCellsBetweenTheTwoHeights) {
  // Floor, two points in one cell, one in another, ceiling, and one outside.
  const std::string cloud =
      "5 5 0\n5.01 5.01 0.51\n5.02 5.03 0.53\n6.11 5.01 0.51\n5 5 2.4\n"
      "9 5 0.5\n";
  const WorldModel world = load(cloud, "point_cloud: {file: scan.xyz}\n");
  EXPECT_FALSE(world.hasUnreadMap());
  ASSERT_EQ(world.boxes.size(), 2U);
  EXPECT_EQ(world.boxes[0].name, "point_cloud_1");
  EXPECT_LT((world.boxes[0].box.size_m - Eigen::Vector3d::Constant(0.05)).norm(), 1e-9);
  EXPECT_LT((world.boxes[0].map_T_box.translation() - Eigen::Vector3d(5.025, 5.025, 0.525)).norm(),
            1e-9);
  const WorldModel coarse =
      load(cloud, "point_cloud: {file: scan.xyz, resolution_m: 0.2, height_m: [0.0, 3.0]}\n");
  ASSERT_EQ(coarse.boxes.size(), 4U);
  EXPECT_LT((coarse.boxes[0].box.size_m - Eigen::Vector3d::Constant(0.2)).norm(), 1e-9);
}

TEST_F(PointCloudWorld, comesBackFromAFile) {
  folder_.write("scan.xyz", "5 5 1\n");
  WorldModel world;
  world.point_cloud = PointCloudFile{folder_.path() / "scan.xyz", 0.1, 0.2, 1.5};
  saveWorldModel(world, folder_.path() / "saved.yaml");
  const WorldModel again = loadWorldModel(folder_.path() / "saved.yaml");
  ASSERT_TRUE(again.point_cloud);
  EXPECT_EQ(again.point_cloud->file, world.point_cloud->file);
  EXPECT_EQ(again.point_cloud->resolution_m, 0.1);
  EXPECT_EQ(again.point_cloud->low_m, 0.2);
  EXPECT_EQ(again.point_cloud->high_m, 1.5);
}

TEST_F(PointCloudWorld, refusesBadEntries) {
  const std::string cloud = "5 5 1\n";
  EXPECT_EQ(errorOf(cloud, "point_cloud: {file: scan.ply}\n"),
            "room.yaml: point_cloud.file: is 'scan.ply'; must be a point cloud, .pcd or .xyz");
  EXPECT_EQ(errorOf(cloud, "point_cloud: {file: scan.xyz, height_m: [2, 1]}\n"),
            "room.yaml: point_cloud.height_m: must be [low, high] with 0 <= low < high <= 100 m");
  EXPECT_EQ(errorOf(cloud, "point_cloud: {file: scan.xyz, resolution_m: 0.001}\n"),
            "room.yaml: point_cloud.resolution_m: is 0.001; must be a number in [0.01, 0.5]");
  EXPECT_EQ(errorOf(cloud, "point_cloud: {file: scan.xyz, colour: red}\n"),
            "room.yaml: point_cloud: unknown key(s): colour");
  EXPECT_EQ(errorOf("50 50 1\n", "point_cloud: {file: scan.xyz}\n"),
            "scan.xyz: holds nothing above the floor within the bounds of world room; is it in the "
            "same frame?");
}

}  // namespace
}  // namespace casepush
