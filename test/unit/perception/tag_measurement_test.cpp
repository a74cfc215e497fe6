#include "../../../src/perception/tag_measurement.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>

#include "perception/tag_scene.h"

namespace casepush {
namespace {

using test::detect;
using test::optical;

constexpr MeasurementNoise kNoNoise{0.01, 0.02, 0.0, 0.0};
constexpr double kGate = 1e-4;

TEST(MeasureObject, recoversAnExactPoseFromAnyView) {
  const ObjectModel model = test::taggedObject(4);
  const Eigen::Isometry3d base_T_camera = optical(Pose2(0.2, 0.1, 0.3), 0.9);
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Pose2 object(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3.1, 3.1));
    const Pose2 robot(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-3.1, 3.1));
    const TagMount& mount = model.tags[i % 4];
    const auto measured = measureObject(
        detect(mount, object, robot, base_T_camera, test::planarTagCovariance(), nullptr),
        {robot, base_T_camera, mount.object_T_tag}, kNoNoise, kGate);
    ASSERT_TRUE(measured);
    EXPECT_NEAR(distance(measured->map_T_object, object), 0.0, 1e-9);
    EXPECT_NEAR(yawDifference(measured->map_T_object, object), 0.0, 1e-9);
  }
}

// The covariance must be that of the errors: mean squared Mahalanobis distance 3.
TEST(MeasureObject, covarianceAgreesWithTheErrors) {
  const ObjectModel model = test::taggedObject(1);
  const Eigen::Isometry3d base_T_camera = optical(Pose2(0.2, 0.0, 0.0), 0.9);
  const Pose2 object(2.0, 0.4, 2.9);
  Random random(5);
  double sum = 0.0;
  constexpr int kCount = 4000;
  Eigen::Matrix3d mean_covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const auto detection =
        detect(model.tags[0], object, Pose2(), base_T_camera, test::planarTagCovariance(), &random);
    const auto measured = measureObject(
        detection, {Pose2(), base_T_camera, model.tags[0].object_T_tag}, kNoNoise, 1e-12);
    ASSERT_TRUE(measured);
    const Eigen::Vector3d error(measured->map_T_object.x() - object.x(),
                                measured->map_T_object.y() - object.y(),
                                yawDifference(object, measured->map_T_object));
    sum += error.dot(measured->covariance.inverse() * error);
    mean_covariance += measured->covariance / kCount;
  }
  // A little conservative: the tolerance for tilt is not used up by the simulated object.
  EXPECT_GT(sum / kCount, 2.0);
  EXPECT_LT(sum / kCount, 3.2);
  // The tag's yaw about the camera's vertical axis is uncertain, and the lever arm carries it on.
  EXPECT_GT(std::sqrt(mean_covariance(2, 2)), 0.03);
  EXPECT_GT(std::sqrt(mean_covariance(1, 1)), 0.3 * 0.03);
}

TEST(MeasureObject, localisationErrorGrowsWithTheDistance) {
  const MeasurementNoise noise{0.01, 0.02, 0.005, 0.01};
  const Eigen::Matrix3d near = localisationCovariance(Pose2(), {1.0, 0.0}, noise);
  const Eigen::Matrix3d far = localisationCovariance(Pose2(), {4.0, 0.0}, noise);
  EXPECT_NEAR(near(1, 1), 0.005 * 0.005 + 0.01 * 0.01, 1e-12);
  EXPECT_NEAR(far(1, 1), 0.005 * 0.005 + 0.04 * 0.04, 1e-12);
  EXPECT_NEAR(far(0, 0), 0.005 * 0.005, 1e-12);
  EXPECT_NEAR(far(1, 2), 4.0 * 0.01 * 0.01, 1e-12);
}

TEST(MeasureObject, rejectsTiltedFloatingAndBrokenDetections) {
  const ObjectModel model = test::taggedObject(1);
  const Eigen::Isometry3d base_T_camera = optical(Pose2(0.2, 0.0, 0.0), 0.9);
  const TagView view{Pose2(), base_T_camera, model.tags[0].object_T_tag};
  const TagDetection good = detect(model.tags[0], Pose2(2.0, 0.0, M_PI), Pose2(), base_T_camera,
                                   test::planarTagCovariance(), nullptr);
  ASSERT_TRUE(measureObject(good, view, kNoNoise, kGate));

  TagDetection tilted = good;
  tilted.camera_T_tag.linear() =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix() *
      good.camera_T_tag.linear();
  EXPECT_FALSE(measureObject(tilted, view, kNoNoise, kGate));

  TagDetection floating = good;
  floating.camera_T_tag.translation().y() -= 0.3;
  EXPECT_FALSE(measureObject(floating, view, kNoNoise, kGate));

  TagDetection nan = good;
  nan.camera_T_tag.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(measureObject(nan, view, kNoNoise, kGate));

  TagDetection bad_covariance = good;
  bad_covariance.covariance(0, 0) = -1.0;
  EXPECT_FALSE(measureObject(bad_covariance, view, kNoNoise, kGate));

  TagDetection no_rotation = good;
  no_rotation.camera_T_tag.linear() *= 2.0;
  EXPECT_FALSE(measureObject(no_rotation, view, kNoNoise, kGate));
}

}  // namespace
}  // namespace casepush
