#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "casepush/cases/case_base.h"
#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "common/temporary_folder.h"

namespace casepush {

inline Pose2 randomPose(Random& random, double position_sigma_m = 0.3, double yaw_sigma_rad = 0.4) {
  const double x = random.normal(position_sigma_m);
  const double y = random.normal(position_sigma_m);
  return {x, y, random.normal(yaw_sigma_rad)};
}

/// A push as it is recorded: one observation, no round numbers.
inline Case recordedCase(std::uint64_t seed, int steps = 30, const std::string& object = "chair") {
  Random random(seed);
  Case push_case;
  push_case.object = object;
  push_case.robot = "cobot";
  push_case.period_s = 0.1;
  push_case.push_steps = steps / 2 + 1;
  for (int i = 0; i < steps; ++i) {
    CaseStep step;
    step.object_T_robot = randomPose(random);
    step.action = {random.normal(0.3), random.normal(0.1), random.normal(0.2)};
    step.start_T_object = randomPose(random);
    push_case.steps.push_back(step);
  }
  const OutcomeStatistics first = addObservation({}, push_case.steps.back().start_T_object, {});
  push_case.start_outcome = first.start_outcome;
  push_case.effective_count = first.effective_count;
  push_case.observation_count = 1;
  return push_case;
}

/// A push of which only the resting pose is known.
inline ObservedPush restingAt(const Pose2& start_T_object) {
  ObservedPush push;
  push.start_T_object = start_T_object;
  return push;
}

inline void expectSamePose(const Pose2& a, const Pose2& b) {
  EXPECT_EQ(a.x(), b.x());
  EXPECT_EQ(a.y(), b.y());
  EXPECT_EQ(a.yaw(), b.yaw());
}

/// Bit for bit, except for the id.
inline void expectSameCase(const Case& a, const Case& b) {
  EXPECT_EQ(a.object, b.object);
  EXPECT_EQ(a.robot, b.robot);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.period_s, b.period_s);
  EXPECT_EQ(a.push_steps, b.push_steps);
  expectSamePose(a.start_outcome.mean, b.start_outcome.mean);
  EXPECT_EQ(a.start_outcome.covariance, b.start_outcome.covariance);
  EXPECT_EQ(a.effective_count, b.effective_count);
  EXPECT_EQ(a.observation_count, b.observation_count);
  EXPECT_EQ(a.context, b.context);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    expectSamePose(a.steps[i].object_T_robot, b.steps[i].object_T_robot);
    expectSamePose(a.steps[i].start_T_object, b.steps[i].start_T_object);
    EXPECT_EQ(a.steps[i].action.vx_mps, b.steps[i].action.vx_mps);
    EXPECT_EQ(a.steps[i].action.vy_mps, b.steps[i].action.vy_mps);
    EXPECT_EQ(a.steps[i].action.wz_rps, b.steps[i].action.wz_rps);
  }
}

inline void expectSameTube(const Case& a, const Case& b) {
  ASSERT_EQ(a.tube.size(), b.tube.size());
  for (std::size_t i = 0; i < a.tube.size(); ++i) {
    expectSamePose(a.tube[i].mean, b.tube[i].mean);
    EXPECT_EQ(a.tube[i].covariance, b.tube[i].covariance);
  }
}

inline void expectSameHistory(const std::vector<ObservedOutcome>& a,
                              const std::vector<ObservedOutcome>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    expectSamePose(a[i].start_T_object, b[i].start_T_object);
    EXPECT_EQ(a[i].source, b[i].source);
    EXPECT_EQ(a[i].past_weight, b[i].past_weight);
    EXPECT_EQ(a[i].noise.position_m, b[i].noise.position_m);
    EXPECT_EQ(a[i].noise.yaw_rad, b[i].noise.yaw_rad);
    EXPECT_EQ(a[i].stamp_s, b[i].stamp_s);
    EXPECT_EQ(a[i].context, b[i].context);
    ASSERT_EQ(a[i].path.size(), b[i].path.size());
    for (std::size_t k = 0; k < a[i].path.size(); ++k) {
      expectSamePose(a[i].path[k], b[i].path[k]);
    }
  }
}

/// The push of a case done again: its trajectory with noise, at another speed.
inline ObservedPush practice(const Case& push_case, Random& random, double sigma = 0.02) {
  ObservedPush push;
  const Pose2 drift = randomPose(random, sigma, sigma);
  const double share = random.uniform(0.7, 1.3);
  const auto count = static_cast<int>(share * static_cast<double>(push_case.steps.size()));
  for (int i = 0; i < std::max(2, count); ++i) {
    const auto at = std::min(push_case.steps.size() - 1, static_cast<std::size_t>(i / share));
    push.steps.push_back(push_case.steps[at]);
    push.steps.back().start_T_object = push_case.steps[at].start_T_object * drift;
  }
  push.push_steps = 1;
  push.start_T_object = push.steps.back().start_T_object;
  push.stamp_s = random.uniform(0.0, 1e9);
  return push;
}

inline std::string readFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

inline void writeFile(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// The message of the InputError that `action` ends with; empty if it ends well.
template <typename Action>
std::string inputErrorOf(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// One line that begins with the file and holds `reason`.
inline void expectRefusal(const std::string& message, const std::filesystem::path& file,
                          const std::string& reason) {
  EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0u) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message << " lacks: " << reason;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace casepush
