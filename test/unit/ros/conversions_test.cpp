#include "casepush/ros/conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"

namespace casepush {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Pose2 randomPose(Random& random) {
  return Pose2(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-M_PI, M_PI));
}

void expectNear(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(distance(a, b), 0.0, 1e-9);
  EXPECT_NEAR(yawDifference(a, b), 0.0, 1e-9);
}

Eigen::Matrix3d someCovariance(Random& random) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) {
    root(i / 3, i % 3) = random.uniform(-1, 1);
  }
  return root * root.transpose();
}

TEST(Conversions, planarPosesComeBack) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = randomPose(random);
    expectNear(fromMessage(toMessage(pose)), pose);
    expectNear(planarPose(fromMessage(toPoseMessage(pose))), pose);
    expectNear(planarPose(fromMessage(toTransformMessage(pose))), pose);
  }
}

TEST(Conversions, spatialPosesComeBack) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d pose =
        Eigen::Translation3d(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)) *
        Eigen::AngleAxisd(random.uniform(-M_PI, M_PI),
                          Eigen::Vector3d(random.uniform(-1, 1), 0.3, 0.5).normalized());
    EXPECT_TRUE(fromMessage(toMessage(pose)).isApprox(pose, 1e-9));
    EXPECT_TRUE(fromMessage(toTransformMessage(pose)).isApprox(pose, 1e-9));
  }
}

TEST(Conversions, refusesWhatIsNotFinite) {
  geometry_msgs::Pose2D planar;
  planar.theta = kNan;
  EXPECT_THROW(fromMessage(planar), InputError);
  geometry_msgs::Pose pose = toPoseMessage(Pose2());
  pose.position.z = kNan;
  EXPECT_THROW(fromMessage(pose), InputError);
  geometry_msgs::Twist twist;
  twist.angular.z = std::numeric_limits<double>::infinity();
  EXPECT_THROW(fromMessage(twist), InputError);
}

TEST(Conversions, refusesQuaternionThatWasNeverSet) {
  try {
    fromMessage(geometry_msgs::Pose());
    FAIL() << "no exception";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no unit quaternion"), std::string::npos);
  }
}

TEST(Conversions, objectCovarianceIsGivenAboutTheAxesOfTheMap) {
  ObjectState state;
  state.id = "chair_1";
  state.map_T_object = Pose2(1, 2, M_PI / 2);
  state.covariance = Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal();
  const PushableObject message = toMessage(state, 0.0);
  // The object's x axis is the map's y axis.
  EXPECT_NEAR(message.pose.covariance[0], 0.01, 1e-12);
  EXPECT_NEAR(message.pose.covariance[7], 0.04, 1e-12);
  EXPECT_NEAR(message.pose.covariance[35], 0.09, 1e-12);
}

TEST(Conversions, objectStatesComeBack) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    ObjectState state;
    state.id = "chair_1";
    state.model = "office_chair";
    state.map_T_object = randomPose(random);
    state.covariance = someCovariance(random);
    state.twist = {0.1, -0.2, 0.3};
    state.stamp_s = 12.5;
    state.moving = i % 2 == 0;
    const PushableObjectArray message = toMessage(std::vector<ObjectState>{state}, 13.0);
    EXPECT_EQ(message.header.frame_id, "map");
    EXPECT_NEAR(message.objects[0].age, 0.5, 1e-9);
    const ObjectState back = fromMessage(message).at(0);
    EXPECT_EQ(back.id, state.id);
    EXPECT_EQ(back.model, state.model);
    EXPECT_EQ(back.moving, state.moving);
    EXPECT_NEAR(back.stamp_s, 12.5, 1e-9);
    expectNear(back.map_T_object, state.map_T_object);
    EXPECT_TRUE(back.covariance.isApprox(state.covariance, 1e-9));
    EXPECT_DOUBLE_EQ(back.twist.vy_mps, -0.2);
  }
}

TEST(Conversions, refusesObjectWithBadCovariance) {
  PushableObject message = toMessage(ObjectState(), 0.0);
  message.pose.covariance[0] = -1.0;
  EXPECT_THROW(fromMessage(message), InputError);
}

TEST(Conversions, tagFramesComeBack) {
  TagFrame frame;
  frame.camera = "front";
  frame.stamp_s = 3.25;
  TagDetection detection;
  detection.id = 7;
  detection.size_m = 0.12;
  detection.camera_T_tag =
      Eigen::Translation3d(0.1, 0.2, 1.5) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY());
  detection.covariance = 0.01 * Eigen::Matrix<double, 6, 6>::Identity();
  detection.covariance(0, 5) = 0.002;
  detection.covariance(5, 0) = 0.002;
  frame.detections = {detection};
  const AprilTagDetectionArray message = toMessage(frame);
  EXPECT_EQ(message.header.frame_id, "front_optical_frame");
  EXPECT_EQ(message.detections[0].pose.header.frame_id, "front_optical_frame");
  const TagFrame back = fromMessage(message);
  EXPECT_EQ(back.camera, "front");
  EXPECT_NEAR(back.stamp_s, 3.25, 1e-9);
  ASSERT_EQ(back.detections.size(), 1U);
  EXPECT_EQ(back.detections[0].id, 7);
  EXPECT_DOUBLE_EQ(back.detections[0].size_m, 0.12);
  EXPECT_TRUE(back.detections[0].camera_T_tag.isApprox(detection.camera_T_tag, 1e-9));
  EXPECT_TRUE(back.detections[0].covariance.isApprox(detection.covariance));
}

TEST(Conversions, leavesOutTagBundles) {
  AprilTagDetectionArray message;
  message.detections.resize(1);
  message.detections[0].id = {1, 2};
  message.detections[0].size = {0.1, 0.1};
  EXPECT_TRUE(fromMessage(message).detections.empty());
}

TEST(Conversions, leavesOutOnlyTheDetectionThatMakesNoSense) {
  TagFrame frame;
  frame.camera = "front";
  frame.detections.resize(3);
  for (int i = 0; i < 3; ++i) frame.detections[i].id = i;
  AprilTagDetectionArray message = toMessage(frame);
  message.detections[0].pose.pose.pose.position.x = std::nan("");
  message.detections[2].pose.pose.pose.orientation.w = 0.0;
  std::string left_out;
  const TagFrame back = fromMessage(message, &left_out);
  ASSERT_EQ(back.detections.size(), 1U);
  EXPECT_EQ(back.detections[0].id, 1);
  EXPECT_EQ(left_out,
            "tag 0: pose message: a number is not finite; tag 2: pose message: the orientation is "
            "no unit quaternion (length 0.000000)");
}

TEST(Conversions, cameraNamesComeFromOpticalFramesOnly) {
  EXPECT_EQ(cameraOfFrame(opticalFrame("left")), "left");
  EXPECT_EQ(cameraOfFrame("base_link"), "");
  EXPECT_EQ(cameraOfFrame("_optical_frame"), "");
}

TEST(Conversions, pointCloudsComeBackWithoutWhatIsNotFinite) {
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {NAN, 0, 0}, {4, 5, 6}};
  const std::vector<Eigen::Vector3f> back = fromMessage(toMessage(points, 1.0));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0], points[0]);
  EXPECT_EQ(back[1], points[2]);
}

TEST(Conversions, refusesBrokenPointClouds) {
  const sensor_msgs::PointCloud2 good = toMessage(std::vector<Eigen::Vector3f>{{1, 2, 3}}, 0.0);
  sensor_msgs::PointCloud2 without_z = good;
  without_z.fields.pop_back();
  EXPECT_THROW(fromMessage(without_z), InputError);
  sensor_msgs::PointCloud2 too_short = good;
  too_short.data.pop_back();
  EXPECT_THROW(fromMessage(too_short), InputError);
  sensor_msgs::PointCloud2 outside = good;
  outside.fields[2].offset = 10;
  EXPECT_THROW(fromMessage(outside), InputError);
}

TEST(Conversions, mapsComeBack) {
  Map map(0.1);
  map.addSurvey({{1.05F, 0.05F, 0.55F}, {2.05F, 0.05F, 0.55F}});
  const Map back = fromMessage(toMessage(map, 2.0));
  EXPECT_DOUBLE_EQ(back.resolution(), 0.1);
  ASSERT_EQ(back.occupied().size(), map.occupied().size());
}

TEST(Conversions, refusesOctomapOfAnotherKind) {
  Octomap message;
  message.id = "ColorOcTree";
  message.binary = true;
  EXPECT_THROW(fromMessage(message), InputError);
}

TEST(Conversions, scansBecomeOrganisedClouds) {
  const auto nan = static_cast<float>(kNan);
  const RangeScan scan{"scanner",
                       2.5,
                       2,
                       3,
                       {{1, 2, 3}, {nan, nan, nan}, {4, 5, 6}, {7, 8, 9}, {1, 1, 1}, {2, 2, 2}}};
  const sensor_msgs::PointCloud2 message = toMessage(scan);
  EXPECT_EQ(message.header.frame_id, "scanner_frame");
  EXPECT_DOUBLE_EQ(message.header.stamp.toSec(), 2.5);
  EXPECT_EQ(message.height, 2U);
  EXPECT_EQ(message.width, 3U);
  EXPECT_FALSE(message.is_dense);
  const std::vector<Eigen::Vector3f> points = fromMessage(message);
  ASSERT_EQ(points.size(), 5U);
  EXPECT_EQ(points[2], Eigen::Vector3f(7, 8, 9));
  const RangeScan back = scanFromMessage(message);
  EXPECT_EQ(back.layers, 2);
  EXPECT_EQ(back.beams, 3);
  EXPECT_DOUBLE_EQ(back.stamp_s, 2.5);
  ASSERT_EQ(back.points.size(), 6U);
  EXPECT_FALSE(back.points[1].allFinite());
  EXPECT_EQ(back.points[3], Eigen::Vector3f(7, 8, 9));
}

TEST(Conversions, floorPlansKeepCellsAndOrigin) {
  nav_msgs::OccupancyGrid message;
  message.info.width = 2;
  message.info.height = 1;
  message.info.resolution = 0.5F;
  message.info.origin = toPoseMessage(Pose2(1.0, 2.0, 0.3));
  message.data = {100, -1};
  const OccupancyGrid grid = fromMessage(message);
  EXPECT_EQ(grid.width, 2);
  EXPECT_EQ(grid.height, 1);
  EXPECT_DOUBLE_EQ(grid.resolution_m, 0.5);
  EXPECT_NEAR(grid.map_T_grid.yaw(), 0.3, 1e-9);
  EXPECT_EQ(grid.cells, (std::vector<std::int8_t>{100, -1}));
  message.info.origin.position.z = 1.0;
  EXPECT_THROW(fromMessage(message), InputError);
}

TEST(Conversions, loadsKeepWhatIsGivenAndLeaveOpenWhatIsZero) {
  const Load load{12.0, {0.1, -0.2}, 0.8, {0.4, 0.5, 0.6}};
  const ObjectLoad message = toMessage("cart_1", load);
  EXPECT_EQ(message.id, "cart_1");
  const Load back = fromMessage(message);
  EXPECT_EQ(back.mass_kg, load.mass_kg);
  EXPECT_EQ(back.object_p_centre_m, load.object_p_centre_m);
  EXPECT_EQ(back.height_m, load.height_m);
  EXPECT_EQ(back.size_m, load.size_m);
  const Load open = fromMessage(ObjectLoad());
  EXPECT_FALSE(open.height_m);
  EXPECT_EQ(open.size_m, Load().size_m);
}

TEST(Conversions, contactsSayWhere) {
  ContactReport report{"cart_1", "body", "robot", "base", 2.5, Eigen::Vector3d(1.0, 2.0, 0.3)};
  const BodyContactArray message = toMessage({report}, 4.0);
  ASSERT_EQ(message.contacts.size(), 1u);
  EXPECT_EQ(message.header.frame_id, "map");
  EXPECT_EQ(message.contacts[0].part_b, "base");
  EXPECT_EQ(message.contacts[0].impulse, 2.5);
  EXPECT_EQ(message.contacts[0].point.y, 2.0);
  EXPECT_EQ(message.contacts[0].point.z, 0.3);
}

}  // namespace
}  // namespace casepush
