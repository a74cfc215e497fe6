#include "casepush/perception/pose_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/pose_gaussian.h"
#include "perception/tag_scene.h"

namespace casepush {
namespace {

using test::detect;
using test::optical;

constexpr double kFrameS = 0.05;

PoseTrackerOptions exactLocalisation() {
  PoseTrackerOptions options;
  options.localisation_sigma_m = 0.0;
  options.localisation_sigma_rad = 0.0;
  return options;
}

// A robot at the origin that looks at a crate with a tag on each of four sides, and sees the tag
// that faces it best.
class Scene {
 public:
  explicit Scene(std::uint64_t seed, PoseTrackerOptions options = exactLocalisation())
      : random_(seed), tracker_({{"crate_1", model_, 0}}, options) {}

  TagFrame frame(const Pose2& object, double stamp_s) {
    TagFrame frame{"front", stamp_s, {}};
    double best = -2.0;
    for (const TagMount& mount : model_.tags) {
      const Eigen::Vector3d into = (test::isometry(object) * mount.object_T_tag).linear().col(2);
      const double facing = into.head<2>().dot(object.position().normalized());
      if (facing > best) {
        best = facing;
        frame.detections = {
            detect(mount, object, Pose2(), base_T_camera_, test::planarTagCovariance(), &random_)};
      }
    }
    return frame;
  }

  void see(const Pose2& object, double stamp_s) { add(frame(object, stamp_s)); }
  void add(const TagFrame& frame) { tracker_.addFrame(frame, Pose2(), base_T_camera_); }

  ObjectState state(double now_s) const {
    const auto states = tracker_.states(now_s);
    EXPECT_EQ(states.size(), 1u);
    return states.empty() ? ObjectState{} : states.front();
  }
  PoseTracker& tracker() { return tracker_; }
  Random& random() { return random_; }

 private:
  ObjectModel model_ = test::taggedObject(4);
  Eigen::Isometry3d base_T_camera_ = optical(Pose2(0.2, 0.0, 0.0), 0.9);
  Random random_;
  PoseTracker tracker_;
};

Eigen::Vector3d errorOf(const ObjectState& state, const Pose2& truth) {
  return logSe2(state.map_T_object.inverse() * truth);
}

// Rest, a push with smooth acceleration and turning, coasting, rest.
Pose2 pushedPose(double t_s, double speed_mps, double yaw_rate_rps) {
  const auto travelled = [](double t) {
    const double ramp = 0.5;
    const double cruise = 2.0;
    if (t <= 0.0) return 0.0;
    if (t < ramp) return 0.5 * t * t / ramp;
    if (t < ramp + cruise) return 0.5 * ramp + (t - ramp);
    const double left = std::max(0.0, 2.0 * ramp + cruise - t);
    return ramp + cruise - 0.5 * left * left / ramp;
  };
  const double s = travelled(t_s - 1.0);
  return Pose2(1.5 + speed_mps * s, 0.2 + 0.3 * speed_mps * s, 0.3 + yaw_rate_rps * s);
}

TEST(PoseTracker, settlesToMillimetresAtRestAndDoesNotMove) {
  int moving = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    Scene scene(seed);
    const Pose2 truth(1.5, 0.2, 0.4);
    for (int i = 0; i < 200; ++i) {
      scene.see(truth, i * kFrameS);
      moving += i > 10 && scene.state(i * kFrameS).moving ? 1 : 0;
    }
    const Eigen::Vector3d error = errorOf(scene.state(200 * kFrameS), truth);
    EXPECT_LT(error.head<2>().norm(), 0.008) << "seed " << seed;
    EXPECT_LT(std::abs(error.z()), 0.02) << "seed " << seed;
  }
  EXPECT_LE(moving, 2);  // Of 3780 images.
}

TEST(PoseTracker, isConsistentOverSimulatedPushes) {
  double sum = 0.0;
  int count = 0;
  int outside = 0;
  for (int seed = 1; seed <= 60; ++seed) {
    Scene scene(seed);
    const double speed = scene.random().uniform(0.1, 0.5);
    const double yaw_rate = scene.random().uniform(-0.8, 0.8);
    for (int i = 0; i < 120; ++i) {
      const double t = i * kFrameS;
      scene.see(pushedPose(t, speed, yaw_rate), t);
      const ObjectState state = scene.state(t);
      const Eigen::Vector3d error = errorOf(state, pushedPose(t, speed, yaw_rate));
      const double nees = error.dot(state.covariance.inverse() * error);
      sum += nees;
      outside += nees > 16.27 ? 1 : 0;  // 99.9 % of a chi-square with 3 degrees of freedom.
      ++count;
    }
  }
  EXPECT_GT(sum / count, 1.5);
  EXPECT_LT(sum / count, 3.5);
  EXPECT_LT(static_cast<double>(outside) / count, 0.02);
}

TEST(PoseTracker, isNotOverconfidentWhenTheRobotIsMislocalised) {
  PoseTrackerOptions options;
  double sum = 0.0;
  constexpr int kRuns = 200;
  for (int seed = 1; seed <= kRuns; ++seed) {
    Scene scene(seed, options);
    // The robot's error stays the same during the run: what it calls the origin lies elsewhere.
    const Pose2 origin_error(scene.random().normal(options.localisation_sigma_m),
                             scene.random().normal(options.localisation_sigma_m),
                             scene.random().normal(options.localisation_sigma_rad));
    const Pose2 seen(1.5, 0.2, 0.4);
    for (int i = 0; i < 100; ++i) {
      scene.see(seen, i * kFrameS);
    }
    const ObjectState state = scene.state(5.0);
    const Eigen::Vector3d error = errorOf(state, origin_error * seen);
    sum += error.dot(state.covariance.inverse() * error);
  }
  EXPECT_GT(sum / kRuns, 1.0);
  EXPECT_LT(sum / kRuns, 3.6);
}

TEST(PoseTracker, saysMovingSoonAfterThePushBeginsAndEnds) {
  for (int seed = 1; seed <= 20; ++seed) {
    Scene scene(seed);
    double first_moving_s = -1.0;
    double last_moving_s = -1.0;
    for (int i = 0; i < 160; ++i) {
      const double t = i * kFrameS;
      scene.see(pushedPose(t, 0.3, 0.3), t);
      const bool moving = t > 0.5 && scene.state(t).moving;
      first_moving_s = moving && first_moving_s < 0.0 ? t : first_moving_s;
      last_moving_s = moving ? t : last_moving_s;
    }
    // Moves from 1.0 s; from 3.9 s on slower than 0.06 m/s; stands from 4.0 s on.
    EXPECT_GT(first_moving_s, 1.0) << "seed " << seed;
    EXPECT_LT(first_moving_s, 1.7) << "seed " << seed;
    EXPECT_GT(last_moving_s, 3.4) << "seed " << seed;
    EXPECT_LT(last_moving_s, 4.31) << "seed " << seed;
  }
}

TEST(PoseTracker, estimatesTheTwistInTheObjectFrame) {
  Scene scene(4);
  for (int i = 0; i < 60; ++i) {
    // Straight along map x while turning.
    scene.see(Pose2(1.0 + 0.3 * i * kFrameS, 0.0, 0.5 * i * kFrameS), i * kFrameS);
  }
  const ObjectState state = scene.state(59 * kFrameS);
  const Twist2 in_map = rotate(state.twist, state.map_T_object.yaw());
  EXPECT_NEAR(in_map.vx_mps, 0.3, 0.08);
  EXPECT_NEAR(in_map.vy_mps, 0.0, 0.08);
  EXPECT_NEAR(state.twist.wz_rps, 0.5, 0.2);
  EXPECT_TRUE(state.moving);
}

TEST(PoseTracker, predictsAtMostAFifthOfASecond) {
  Scene scene(4);
  for (int i = 0; i < 40; ++i) {
    scene.see(Pose2(1.0 + 0.3 * i * kFrameS, 0.0, 0.0), i * kFrameS);
  }
  const double last_s = 39 * kFrameS;
  const double at_last = scene.state(last_s).map_T_object.x();
  EXPECT_NEAR(scene.state(last_s + 0.1).map_T_object.x() - at_last, 0.03, 0.01);
  EXPECT_NEAR(scene.state(last_s + 0.2).map_T_object.x() - at_last, 0.06, 0.02);
  EXPECT_DOUBLE_EQ(scene.state(last_s + 5.0).map_T_object.x(),
                   scene.state(last_s + 0.2).map_T_object.x());
  EXPECT_DOUBLE_EQ(scene.state(last_s + 5.0).stamp_s, last_s);
  EXPECT_TRUE(isCovariance(scene.state(last_s + 5.0).covariance));
}

TEST(PoseTracker, forgetsWhatItHasNotSeenForLong) {
  Scene scene(4);
  scene.see(Pose2(1.5, 0.0, 0.0), 0.0);
  EXPECT_EQ(scene.tracker().states(1799.0).size(), 1u);
  EXPECT_TRUE(scene.tracker().states(1801.0).empty());
}

TEST(PoseTracker, ignoresASingleOutlierAndReacquiresATeleportedObject) {
  Scene scene(8);
  const Pose2 before(1.5, 0.2, 0.4);
  const Pose2 after(2.5, -0.5, -2.0);
  int i = 0;
  for (; i < 60; ++i) {
    scene.see(before, i * kFrameS);
  }
  const int ignored = scene.tracker().ignoredDetections();
  scene.see(after, i++ * kFrameS);
  EXPECT_EQ(scene.tracker().ignoredDetections(), ignored + 1);
  EXPECT_LT(distance(scene.state(i * kFrameS).map_T_object, before), 0.02);
  EXPECT_DOUBLE_EQ(scene.state(i * kFrameS).stamp_s, 59 * kFrameS);

  scene.see(before, i++ * kFrameS);
  for (int k = 0; k < 4; ++k) {
    scene.see(after, i++ * kFrameS);
    EXPECT_LT(distance(scene.state(i * kFrameS).map_T_object, before), 0.03);
  }
  scene.see(after, i++ * kFrameS);
  EXPECT_LT(distance(scene.state(i * kFrameS).map_T_object, after), 0.05);
  for (int k = 0; k < 20; ++k) {
    scene.see(after, i++ * kFrameS);
  }
  EXPECT_LT(distance(scene.state(i * kFrameS).map_T_object, after), 0.02);
  EXPECT_FALSE(scene.state(i * kFrameS).moving);
}

TEST(PoseTracker, scatteredOutliersNeverBecomeTheTrack) {
  Scene scene(8);
  const Pose2 truth(1.5, 0.2, 0.4);
  int i = 0;
  for (; i < 60; ++i) {
    scene.see(truth, i * kFrameS);
  }
  for (int k = 0; k < 20; ++k) {
    scene.see(Pose2(scene.random().uniform(2, 6), scene.random().uniform(-3, 3), 0.4),
              i++ * kFrameS);
  }
  EXPECT_LT(distance(scene.state(i * kFrameS).map_T_object, truth), 0.05);
}

TEST(PoseTracker, lateFramesGiveTheSameResultAsPunctualOnes) {
  Scene source(6);
  Scene punctual(6);
  Scene late(6);
  std::vector<TagFrame> frames;
  for (int i = 0; i < 60; ++i) {
    frames.push_back(source.frame(pushedPose(i * kFrameS, 0.3, 0.2), i * kFrameS));
    punctual.add(frames.back());
  }
  // Every other frame comes three frames late.
  for (int i = 0; i < 66; ++i) {
    if (i < 60 && i % 2 == 0) late.add(frames[i]);
    const int delayed = i - 3;
    if (delayed >= 0 && delayed < 60 && delayed % 2 == 1) late.add(frames[delayed]);
  }
  const ObjectState a = punctual.state(3.0);
  const ObjectState b = late.state(3.0);
  EXPECT_NEAR(distance(a.map_T_object, b.map_T_object), 0.0, 1e-12);
  EXPECT_NEAR(a.covariance.trace(), b.covariance.trace(), 1e-12);
  EXPECT_DOUBLE_EQ(a.stamp_s, b.stamp_s);
}

TEST(PoseTracker, ignoresAndCountsStaleBadAndUnknown) {
  Scene scene(6);
  const Pose2 truth(1.5, 0.0, 0.0);
  for (int i = 0; i < 60; ++i) {
    scene.see(truth, i * kFrameS);
  }
  const int before = scene.tracker().ignoredDetections();
  scene.see(truth, 1.0);  // Older than the newest by almost 2 s.
  EXPECT_EQ(scene.tracker().ignoredDetections(), before + 1);

  const double nan = std::numeric_limits<double>::quiet_NaN();
  scene.see(truth, nan);
  EXPECT_EQ(scene.tracker().ignoredDetections(), before + 2);
  TagFrame frame = scene.frame(truth, 3.1);
  scene.tracker().addFrame(frame, Pose2(nan, 0.0, 0.0), Eigen::Isometry3d::Identity());
  EXPECT_EQ(scene.tracker().ignoredDetections(), before + 3);
  frame.detections[0].id = 99;
  scene.add(frame);
  EXPECT_EQ(scene.tracker().ignoredDetections(), before + 4);
  EXPECT_LT(distance(scene.state(3.1).map_T_object, truth), 0.02);
  EXPECT_DOUBLE_EQ(scene.state(3.1).stamp_s, 59 * kFrameS);
}

TEST(PoseTracker, recoversFromAFrameOutOfTheFuture) {
  for (const bool sees_object : {true, false}) {
    Scene scene(6);
    const Pose2 truth(1.5, 0.0, 0.0);
    int i = 0;
    for (; i < 60; ++i) {
      scene.see(truth, i * kFrameS);
    }
    TagFrame wrong = scene.frame(truth, 1e9);
    if (!sees_object) wrong.detections.clear();
    scene.add(wrong);
    const int before = scene.tracker().ignoredDetections();
    for (int k = 0; k < 4; ++k) {
      scene.see(truth, i++ * kFrameS);
    }
    EXPECT_EQ(scene.tracker().ignoredDetections(), before + 4);
    for (int k = 0; k < 20; ++k) {
      scene.see(truth, i * kFrameS);
      EXPECT_DOUBLE_EQ(scene.state(i * kFrameS).stamp_s, i * kFrameS);
      ++i;
    }
    EXPECT_EQ(scene.tracker().ignoredDetections(), before + 4);
    EXPECT_LT(distance(scene.state(i * kFrameS).map_T_object, truth), 0.03);
  }
}

TEST(PoseTracker, remembersRestingObjectsWhenAFrameOutOfTheFutureWasWrong) {
  Scene scene(6);
  const Pose2 truth(1.5, 0.0, 0.0);
  for (int i = 0; i < 60; ++i) {
    scene.see(truth, i * kFrameS);
  }
  scene.add({"front", 1e9, {}});
  for (int i = 60; i < 80; ++i) {
    scene.add({"front", i * kFrameS, {}});
  }
  EXPECT_LT(distance(scene.state(4.0).map_T_object, truth), 0.02);
  EXPECT_DOUBLE_EQ(scene.state(4.0).stamp_s, 59 * kFrameS);
}

TEST(PoseTracker, ignoresOldFramesAsLongAsNewOnesCome) {
  Scene scene(6);
  const Pose2 truth(1.5, 0.0, 0.0);
  for (int i = 0; i < 60; ++i) {
    scene.see(truth, 100.0 + i * kFrameS);
    if (i % 2 == 0) scene.see(Pose2(3.0, 1.0, 0.0), i * kFrameS);
  }
  EXPECT_EQ(scene.tracker().ignoredDetections(), 30);
  // Nor do old ones count that are from here and there.
  for (int i = 0; i < 20; ++i) {
    scene.see(Pose2(3.0, 1.0, 0.0), 2.0 * i);
  }
  EXPECT_EQ(scene.tracker().ignoredDetections(), 50);
  EXPECT_LT(distance(scene.state(103.0).map_T_object, truth), 0.02);
}

TEST(PoseTracker, clearForgetsAndAcceptsEarlierStamps) {
  Scene scene(6);
  scene.see(Pose2(1.5, 0.0, 0.0), 100.0);
  scene.tracker().clear();
  EXPECT_TRUE(scene.tracker().states(100.0).empty());
  scene.see(Pose2(2.0, 0.0, 0.0), 1.0);
  EXPECT_NEAR(scene.state(1.0).map_T_object.x(), 2.0, 0.1);
}

TEST(PoseTracker, tellsInstancesApartByTheirTagOffset) {
  const ObjectModel model = test::taggedObject(1);
  PoseTracker tracker({{"a", model, 0}, {"b", model, 100}}, exactLocalisation());
  const Eigen::Isometry3d base_T_camera = optical(Pose2(0.2, 0.0, 0.0), 0.9);
  TagMount mount = model.tags[0];
  TagFrame frame{"front", 1.0, {}};
  frame.detections.push_back(detect(mount, Pose2(2.0, 1.0, M_PI), Pose2(), base_T_camera,
                                    test::planarTagCovariance(), nullptr));
  mount.id += 100;
  frame.detections.push_back(detect(mount, Pose2(3.0, -1.0, M_PI), Pose2(), base_T_camera,
                                    test::planarTagCovariance(), nullptr));
  tracker.addFrame(frame, Pose2(), base_T_camera);
  const auto states = tracker.states(1.0);
  ASSERT_EQ(states.size(), 2u);
  EXPECT_NEAR(states[0].map_T_object.x(), 2.0, 1e-6);
  EXPECT_NEAR(states[1].map_T_object.x(), 3.0, 1e-6);
}

}  // namespace
}  // namespace casepush
