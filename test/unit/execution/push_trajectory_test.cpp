#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/execution/execute_push.h"

namespace casepush {
namespace {

PushConfiguration straight(double speed_mps, double duration_s) {
  PushConfiguration push;
  push.object_T_robot = Pose2(-0.7, 0.1, 0.4);
  push.direction_rad = 0.3;
  push.speed_mps = speed_mps;
  push.duration_s = duration_s;
  return push;
}

TEST(PushTrajectory, isATrapezoidOfTheRightArea) {
  const RobotLimits limits;
  const PushTrajectory t = pushTrajectory(straight(0.3, 2.0), limits, 0.1);
  ASSERT_EQ(t.start_T_robot.size(), 21u);
  ASSERT_EQ(t.action.size(), 21u);
  EXPECT_DOUBLE_EQ(t.durationS(), 2.0);
  // Distance of a trapezoid: v (T - v / a).
  const double expected = 0.3 * (2.0 - 0.3 / limits.max_acceleration_mps2);
  EXPECT_NEAR(distance(t.start_T_robot.front(), t.start_T_robot.back()), expected, 1e-9);
  EXPECT_NEAR(t.startDirectionRad(), 0.7, 1e-9);
  EXPECT_NEAR(t.action.front().speed(), 0.0, 1e-12);
  EXPECT_NEAR(t.action.back().speed(), 0.0, 1e-12);
  EXPECT_NEAR(t.actionAt(1.0).speed(), 0.3, 1e-12);
  for (std::size_t i = 1; i < t.action.size(); ++i) {
    EXPECT_LE(std::abs(t.action[i].speed() - t.action[i - 1].speed()),
              limits.max_acceleration_mps2 * 0.1 + 1e-9);
  }
}

TEST(PushTrajectory, isATriangleIfThereIsNoTimeForMore) {
  const RobotLimits limits;
  const PushTrajectory t = pushTrajectory(straight(0.5, 0.6), limits, 0.05);
  // Peak a T / 2 = 0.24 m/s, area half of peak times T.
  EXPECT_NEAR(distance(t.start_T_robot.front(), t.start_T_robot.back()), 0.5 * 0.24 * 0.6, 1e-9);
  for (const Twist2& action : t.action) {
    EXPECT_LE(action.speed(), 0.24 + 1e-9);
  }
}

TEST(PushTrajectory, posesAreTheIntegralOfTheActions) {
  RobotLimits limits;
  PushConfiguration push = straight(0.4, 1.7);
  push.yaw_rate_rps = -0.8;
  const PushTrajectory t = pushTrajectory(push, limits, 0.05);
  Pose2 pose = push.object_T_robot;
  constexpr int kSubsteps = 2000;
  const double dt_s = t.durationS() / kSubsteps;
  for (int i = 0; i < kSubsteps; ++i) {
    const Twist2 twist = t.actionAt((i + 0.5) * dt_s);
    pose = pose * expSe2(dt_s * Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps));
  }
  EXPECT_LT(distance(pose, t.start_T_robot.back()), 2e-3);
  EXPECT_NEAR(yawDifference(pose, t.start_T_robot.back()), 0.0, 5e-3);
}

TEST(PushTrajectory, staysAtItsEnds) {
  const PushTrajectory t = pushTrajectory(straight(0.3, 1.0), RobotLimits{}, 0.1);
  EXPECT_NEAR(distance(t.poseAt(-5.0), t.start_T_robot.front()), 0.0, 1e-12);
  EXPECT_NEAR(distance(t.poseAt(50.0), t.start_T_robot.back()), 0.0, 1e-12);
  EXPECT_NEAR(distance(t.poseAt(0.5), t.start_T_robot[5]), 0.0, 1e-9);
}

TEST(PushTrajectory, refusesWhatTheRobotCanNotDo) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const RobotLimits limits;
  EXPECT_THROW(pushTrajectory(straight(nan, 1.0), limits, 0.1), InputError);
  EXPECT_THROW(pushTrajectory(straight(0.0, 1.0), limits, 0.1), InputError);
  EXPECT_THROW(pushTrajectory(straight(0.3, nan), limits, 0.1), InputError);
  EXPECT_THROW(pushTrajectory(straight(0.3, 1e9), limits, 0.1), InputError);
  try {
    pushTrajectory(straight(0.9, 1.0), limits, 0.1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("push configuration: speed_mps is 0.9, must be in"),
              std::string::npos)
        << error.what();
  }
}

Case recording(const PushTrajectory& trajectory, double noise_m, Random& random) {
  Case push_case;
  push_case.id = 5;
  push_case.object = "chair";
  push_case.robot = "robot";
  push_case.period_s = trajectory.period_s;
  for (std::size_t i = 0; i < trajectory.start_T_robot.size(); ++i) {
    CaseStep step;
    step.start_T_object = Pose2(0.01 * i, 0.0, 0.02 * i);
    const Pose2 robot =
        trajectory.start_T_robot[i] * Pose2(random.normal(noise_m), random.normal(noise_m), 0.0);
    step.object_T_robot = step.start_T_object.inverse() * robot;
    step.action = trajectory.action[i];
    push_case.steps.push_back(step);
  }
  push_case.push_steps = static_cast<int>(push_case.steps.size());
  push_case.steps.push_back(push_case.steps.back());
  push_case.effective_count = 1;
  push_case.observation_count = 1;
  push_case.start_outcome.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  return push_case;
}

TEST(PushTrajectory, ofACaseIsItsPushingPhase) {
  Random random(1);
  const PushTrajectory original = pushTrajectory(straight(0.3, 2.0), RobotLimits{}, 0.1);
  const PushTrajectory replayed = pushTrajectory(recording(original, 0.0, random));
  ASSERT_EQ(replayed.start_T_robot.size(), original.start_T_robot.size());
  EXPECT_DOUBLE_EQ(replayed.durationS(), original.durationS());
  for (std::size_t i = 0; i < original.start_T_robot.size(); ++i) {
    EXPECT_LT(distance(replayed.start_T_robot[i], original.start_T_robot[i]), 2.1e-3);
    EXPECT_LT(std::abs(replayed.action[i].vx_mps - original.action[i].vx_mps), 0.021);
  }
}

double roughness(const std::vector<Pose2>& poses) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    sum += (poses[i + 1].position() - 2.0 * poses[i].position() + poses[i - 1].position())
               .squaredNorm();
  }
  return std::sqrt(sum / poses.size());
}

TEST(PushTrajectory, smoothsTheNoiseOfARecording) {
  Random random(2);
  PushConfiguration push = straight(0.3, 3.0);
  const PushTrajectory original = pushTrajectory(push, RobotLimits{}, 0.1);
  const Case noisy = recording(original, 0.005, random);
  std::vector<Pose2> raw;
  for (int i = 0; i < noisy.push_steps; ++i) {
    raw.push_back(noisy.steps[i].start_T_robot());
  }
  const PushTrajectory smooth = pushTrajectory(noisy);
  EXPECT_LT(roughness(smooth.start_T_robot), 0.45 * roughness(raw));
}

}  // namespace
}  // namespace casepush
