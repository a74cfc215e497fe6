#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "casepush/cases/case_base.h"
#include "casepush/common/input_error.h"
#include "casepush/common/random.h"

namespace casepush {

/// A fresh folder, gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "casepush_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error("no temporary folder");
    }
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

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
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    expectSamePose(a.steps[i].object_T_robot, b.steps[i].object_T_robot);
    expectSamePose(a.steps[i].start_T_object, b.steps[i].start_T_object);
    EXPECT_EQ(a.steps[i].action.vx_mps, b.steps[i].action.vx_mps);
    EXPECT_EQ(a.steps[i].action.vy_mps, b.steps[i].action.vy_mps);
    EXPECT_EQ(a.steps[i].action.wz_rps, b.steps[i].action.wz_rps);
  }
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
