#include <fcl/narrowphase/collision.h>
#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

#include "casepush/world/collision_checker.h"
#include "world/random_scene.h"

namespace casepush {
namespace {

/// FCL's own geometry and algorithms, over every occupied leaf near by.
class FclOracle {
 public:
  FclOracle(const Solid& solid, const std::vector<Map::Voxel>& voxels) : voxels_(voxels) {
    for (const PlacedShape& shape : solid) {
      parts_.push_back({geometry(shape.shape), shape.frame_T_shape});
    }
  }

  bool collides(const Pose2& pose, double shrink_m) const {
    const Eigen::Isometry3d map_T_solid = placed(pose.x(), pose.y(), 0.0, pose.yaw());
    for (const auto& voxel : voxels_) {
      if (voxel.centre_m.z() + voxel.size_m / 2 < 0.051) continue;
      const Eigen::Vector2d offset = voxel.centre_m.head<2>().cast<double>() - pose.position();
      if (offset.norm() > 0.9 + voxel.size_m) continue;
      const double size = voxel.size_m - 2 * shrink_m;
      const fcl::Boxd cell(size, size, size);
      const Eigen::Isometry3d map_T_cell(Eigen::Translation3d(voxel.centre_m.cast<double>()));
      for (const auto& [shape, solid_T_shape] : parts_) {
        fcl::CollisionRequestd request;
        fcl::CollisionResultd result;
        if (fcl::collide(shape.get(), map_T_solid * solid_T_shape, &cell, map_T_cell, request,
                         result) > 0) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  static std::shared_ptr<fcl::CollisionGeometryd> geometry(const Shape& shape) {
    if (const auto* box = std::get_if<Box>(&shape)) {
      return std::make_shared<fcl::Boxd>(box->size_m.x(), box->size_m.y(), box->size_m.z());
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      return std::make_shared<fcl::Cylinderd>(cylinder->radius_m, cylinder->length_m);
    }
    return std::make_shared<fcl::Sphered>(std::get<Sphere>(shape).radius_m);
  }

  std::vector<Map::Voxel> voxels_;
  std::vector<std::pair<std::shared_ptr<fcl::CollisionGeometryd>, Eigen::Isometry3d>> parts_;
};

Solid leaningSolid() {
  Solid solid = overbedTable();
  solid.push_back({Box{{0.4, 0.05, 0.5}}, placed(-0.2, 0.1, 0.4, 0.3, 0.5), "back"});
  solid.push_back({Sphere{0.12}, placed(0.3, -0.2, 0.3), "ball"});
  return solid;
}

TEST(CollisionOracleTest, agreesWithFcl) {
  Random random(2);
  using Clock = std::chrono::steady_clock;
  Clock::duration fcl_time{};
  Clock::duration our_time{};
  int tested = 0;
  int hits = 0;
  int unsure = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const Map map = mapOf(randomRoom(&random, 4.0, 9), 0.05);
    const CollisionChecker checker(map);
    const auto footprint = checker.footprint(leaningSolid());
    const FclOracle oracle(leaningSolid(), map.occupied());
    for (int i = 0; i < 1000; ++i) {
      const Pose2 pose = randomPose(&random, 0.65, 3.35);
      const auto start = Clock::now();
      const bool ours = checker.collides(*footprint, pose);
      const auto middle = Clock::now();
      const bool theirs = oracle.collides(pose, 0.0);
      our_time += middle - start;
      fcl_time += Clock::now() - middle;
      // Iterative solvers answer contacts within their tolerance either way.
      if (ours != theirs && oracle.collides(pose, 1e-4) != oracle.collides(pose, -1e-4)) {
        ++unsure;
        continue;
      }
      EXPECT_EQ(ours, theirs) << pose.x() << " " << pose.y() << " " << pose.yaw();
      ++tested;
      hits += ours;
    }
  }
  std::cout << tested << " tests, " << hits << " hits, " << unsure << " contacts; per test "
            << std::chrono::duration<double, std::micro>(our_time).count() / tested << " us, FCL "
            << std::chrono::duration<double, std::micro>(fcl_time).count() / tested << " us\n";
  EXPECT_GT(tested, 9950);
  EXPECT_GT(hits, 2000);
}

}  // namespace
}  // namespace casepush
