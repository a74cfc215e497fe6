#include "tag_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "casepush/common/pose_gaussian.h"
#include "casepush/sim/simulator.h"
#include "sim/scenes.h"
#include "tag_pose.h"

namespace casepush::sim {
namespace {

using test::makeCamera;

// Robot at the origin facing +x, the cart's tag 2.2 m in front of the camera.
WorldModel facingWorld() {
  WorldModel world = test::makeCartWorld(Pose2(2.8, 0.0, M_PI - 0.5));
  world.map_T_robot = Pose2();
  world.objects[0].tag_offset = 40;
  return world;
}

Simulator makeSimulator(const WorldModel& world, const CameraModel& camera, bool noise) {
  RobotModel robot = test::makeRobot();
  robot.cameras = {camera};
  SimulatorOptions options;
  options.sensor_noise = noise;
  return Simulator(world, robot, {{"cart", test::makeCart()}}, options);
}

std::size_t detectionsAfterOneStep(const WorldModel& world, const CameraModel& camera) {
  Simulator simulator = makeSimulator(world, camera, false);
  simulator.step();
  const auto frames = simulator.takeTagFrames();
  EXPECT_EQ(frames.size(), 1u);
  return frames.empty() ? 0 : frames[0].detections.size();
}

TEST(TagCameras, seeTheTrueTagWithoutNoise) {
  Simulator simulator = makeSimulator(facingWorld(), makeCamera(), false);
  simulator.step(3);
  const auto frames = simulator.takeTagFrames();
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].camera, "front");
  EXPECT_DOUBLE_EQ(frames[0].stamp_s, simulator.stepSeconds());
  ASSERT_EQ(frames[0].detections.size(), 1u);
  const TagDetection& tag = frames[0].detections[0];
  EXPECT_EQ(tag.id, 41);
  EXPECT_DOUBLE_EQ(tag.size_m, 0.16);
  const Eigen::Isometry3d map_T_object = simulator.trueLinkPoses("cart_1")[0];
  const Eigen::Isometry3d expected =
      makeCamera().base_T_camera.inverse() * map_T_object * test::makeCart().tags[0].object_T_tag;
  // A wheel yields by some hundredths of a millimetre, more or less as the load is shared.
  EXPECT_LT((tag.camera_T_tag.matrix() - expected.matrix()).norm(), 3e-5);
}

TEST(TagCameras, doNotSeeThroughWalls) {
  WorldModel world = facingWorld();
  EXPECT_EQ(detectionsAfterOneStep(world, makeCamera()), 1u);
  world.boxes.push_back(test::makeBox("wall", {0.05, 1.0, 1.2}, 1.2, 0.0));
  EXPECT_EQ(detectionsAfterOneStep(world, makeCamera()), 0u);
  world.boxes[0] = test::makeBox("low_wall", {0.05, 1.0, 0.2}, 1.2, 0.0);
  EXPECT_EQ(detectionsAfterOneStep(world, makeCamera()), 1u);
  // Hides one edge of the tag only.
  world.boxes[0] = test::makeBox("post", {0.05, 0.3, 1.2}, 1.2, 0.17);
  EXPECT_EQ(detectionsAfterOneStep(world, makeCamera()), 0u);
}

TEST(TagCameras, doNotSeeThroughTheObjectItself) {
  WorldModel world = facingWorld();
  world.objects[0].map_T_object = Pose2(2.8, 0.0, 0.0);  // The tag is on the far side.
  CameraModel camera = makeCamera();
  camera.max_view_angle_rad = M_PI;
  EXPECT_EQ(detectionsAfterOneStep(world, camera), 0u);
}

TEST(TagCameras, respectRangeViewAngleAndFieldOfView) {
  const WorldModel world = facingWorld();
  CameraModel camera = makeCamera();
  camera.max_range_m = 2.0;
  EXPECT_EQ(detectionsAfterOneStep(world, camera), 0u);
  camera = makeCamera();
  camera.max_view_angle_rad = 0.3;
  EXPECT_EQ(detectionsAfterOneStep(world, camera), 0u);
  camera = makeCamera();
  camera.horizontal_fov_rad = 0.05;
  EXPECT_EQ(detectionsAfterOneStep(world, camera), 0u);
  camera = makeCamera();
  camera.base_T_camera.linear().col(0) *= -1.0;  // Looks backwards.
  camera.base_T_camera.linear().col(2) *= -1.0;
  EXPECT_EQ(detectionsAfterOneStep(world, camera), 0u);
}

TEST(TagCameras, deliverEachImageOnceAfterItsLatency) {
  CameraModel camera = makeCamera();
  camera.rate_hz = 20.0;
  camera.latency_s = 0.1;
  Simulator simulator = makeSimulator(facingWorld(), camera, false);
  double last_stamp_s = -1.0;
  int frames = 0;
  for (int i = 0; i < 480; ++i) {
    simulator.step();
    for (const TagFrame& frame : simulator.takeTagFrames()) {
      EXPECT_NEAR(simulator.time() - frame.stamp_s, 0.1, 1e-9);
      EXPECT_GT(frame.stamp_s, last_stamp_s);
      last_stamp_s = frame.stamp_s;
      ++frames;
    }
  }
  EXPECT_NEAR(frames, 20 * 1.9, 1.0);
}

TEST(TagCameras, dropTagsAsOftenAsTheModelSays) {
  CameraModel camera = makeCamera();
  camera.dropout = 0.3;
  camera.rate_hz = 240.0;
  Simulator simulator = makeSimulator(facingWorld(), camera, true);
  simulator.step(960);
  int seen = 0;
  const auto frames = simulator.takeTagFrames();
  for (const TagFrame& frame : frames) seen += static_cast<int>(frame.detections.size());
  EXPECT_EQ(frames.size(), 960u);
  EXPECT_NEAR(seen / 960.0, 0.7, 0.06);  // 4 standard deviations.
}

TEST(TagCameras, reportACovarianceThatFitsTheirErrors) {
  CameraModel camera = makeCamera();
  camera.rate_hz = 240.0;
  Simulator simulator = makeSimulator(facingWorld(), camera, true);
  simulator.step(600);
  const Eigen::Isometry3d truth = camera.base_T_camera.inverse() *
                                  simulator.trueLinkPoses("cart_1")[0] *
                                  test::makeCart().tags[0].object_T_tag;
  double sum = 0.0;
  int count = 0;
  for (const TagFrame& frame : simulator.takeTagFrames()) {
    for (const TagDetection& tag : frame.detections) {
      Eigen::Matrix<double, 6, 1> error;
      error.head<3>() = truth.translation() - tag.camera_T_tag.translation();
      const Eigen::AngleAxisd turn(
          Eigen::Matrix3d(truth.linear() * tag.camera_T_tag.linear().transpose()));
      error.tail<3>() = turn.angle() * turn.axis();
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(tag.covariance);
      ASSERT_GT(eigen.eigenvalues().minCoeff(), 0.0);
      sum += error.dot(tag.covariance.ldlt().solve(error));
      ++count;
    }
  }
  ASSERT_EQ(count, 600);
  // Chi-square with 6 degrees of freedom: mean 6, standard deviation of the mean 0.14.
  EXPECT_NEAR(sum / count, 6.0, 0.6);
}

TEST(EstimateTagPose, noiseGrowsWithRange) {
  const CameraModel camera = makeCamera();
  double last_sigma_m = 0.0;
  for (const double range_m : {1.0, 2.0, 4.0}) {
    Eigen::Isometry3d camera_T_tag = test::at(0.0, 0.0, range_m);
    camera_T_tag.rotate(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitY()));
    Corners corners;
    for (std::size_t i = 0; i < 4; ++i) {
      corners[i] = project(camera, camera_T_tag * tagCorners(0.16)[i]);
    }
    const auto estimate = estimateTagPose(camera, 0.16, corners, camera_T_tag, 0.3);
    const double sigma_m = std::sqrt(estimate.covariance(2, 2));
    // Depth follows from apparent size: its deviation grows with the square of the range.
    if (last_sigma_m > 0.0) {
      EXPECT_NEAR(sigma_m / last_sigma_m, 4.0, 0.4);
    }
    last_sigma_m = sigma_m;
  }
}

/// Standard deviations of depth and of the turn about the image's y axis.
Eigen::Vector2d tagNoise(const CameraModel& camera, double range_m, double angle_rad) {
  Eigen::Isometry3d camera_T_tag = test::at(0.0, 0.0, range_m);
  camera_T_tag.rotate(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()));
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = project(camera, camera_T_tag * tagCorners(0.16)[i]);
  }
  const auto covariance =
      estimateTagPose(camera, 0.16, corners, camera_T_tag, camera.corner_noise_px).covariance;
  return {std::sqrt(covariance(2, 2)), std::sqrt(covariance(4, 4))};
}

// Seen from the front, depth comes from the size of the tag: sigma z^2 / (sqrt(2) f s); its turn
// from perspective only: 2 sigma z^2 / (f s^2). Seen at an angle, the width tells the turn, and
// depth is left with the height: sigma z^2 / (f s).
TEST(EstimateTagPose, noiseFollowsFromRangeAndViewingAngle) {
  CameraModel camera = makeCamera();
  camera.corner_noise_px = 0.3;
  const double f_s = camera.focalPx() * 0.16;
  for (const double z : {1.0, 3.0}) {
    const Eigen::Vector2d front = tagNoise(camera, z, 0.0);
    EXPECT_NEAR(front[0], 0.3 * z * z / (std::sqrt(2.0) * f_s), 0.02 * front[0]);
    EXPECT_NEAR(front[1], 2.0 * 0.3 * z * z / (f_s * 0.16), 0.02 * front[1]);
    const Eigen::Vector2d oblique = tagNoise(camera, z, 0.8);
    EXPECT_NEAR(oblique[0], 0.3 * z * z / f_s, 0.05 * oblique[0]);
    EXPECT_LT(oblique[1], 0.2 * front[1]);
    EXPECT_GT(tagNoise(camera, z, 0.2)[1], tagNoise(camera, z, 0.6)[1]);
  }
}

TEST(TagCameras, areExactOrAbsentBySwitch) {
  CameraModel camera = makeCamera();
  camera.dropout = 0.9;
  camera.rate_hz = 240.0;
  const auto detections = [&](bool noise) {
    Simulator simulator = makeSimulator(facingWorld(), camera, noise);
    simulator.step(100);
    std::vector<TagDetection> all;
    for (const TagFrame& frame : simulator.takeTagFrames()) {
      all.insert(all.end(), frame.detections.begin(), frame.detections.end());
    }
    return all;
  };
  EXPECT_LT(detections(true).size(), 40U);
  camera.switches.noise = false;
  const auto exact = detections(true);
  ASSERT_EQ(exact.size(), 100U);
  EXPECT_EQ(exact.back().camera_T_tag.matrix(), detections(false).back().camera_T_tag.matrix());
  camera.switches.enabled = false;
  Simulator blind = makeSimulator(facingWorld(), camera, true);
  blind.step(100);
  EXPECT_TRUE(blind.takeTagFrames().empty());
}

TEST(EstimateTagPose, convergesFromAnOffset) {
  const CameraModel camera = makeCamera();
  Eigen::Isometry3d camera_T_tag = test::at(0.2, -0.1, 1.5);
  camera_T_tag.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, 0.9, 0.1).normalized()));
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = project(camera, camera_T_tag * tagCorners(0.16)[i]);
  }
  Eigen::Isometry3d initial = camera_T_tag;
  initial.translation() += Eigen::Vector3d(0.05, 0.05, 0.2);
  initial.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  const auto estimate = estimateTagPose(camera, 0.16, corners, initial, 0.3);
  EXPECT_LT((estimate.camera_T_tag.matrix() - camera_T_tag.matrix()).norm(), 1e-6);
}

}  // namespace
}  // namespace casepush::sim
