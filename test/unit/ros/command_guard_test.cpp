#include "casepush/ros/command_guard.h"

#include <gtest/gtest.h>

#include <limits>

namespace casepush {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Row {
  Twist2 wanted;
  double robot_age_s;
  double objects_age_s;
  const char* reason;  ///< Part of it; nullptr: passes.
};

TEST(CommandGuard, letsOnlyGoodCommandsPass) {
  RobotLimits limits;
  limits.max_speed_mps = 0.5;
  limits.max_yaw_rate_rps = 1.0;
  const CommandGuard guard(limits, 0.2, 0.3);
  const Row rows[] = {
      {{0.3, 0.4, 1.0}, 0.2, 0.3, nullptr},       {{0.3, 0.4, -1.0}, -0.01, 0.0, nullptr},
      {{0.1, 0, 0}, 0.21, 0.0, "robot's pose"},   {{0.1, 0, 0}, kNan, 0.0, "robot's pose"},
      {{0.1, 0, 0}, 0.0, 0.31, "objects' poses"}, {{0.1, 0, kNan}, 0.0, 0.0, "finite"},
      {{0.4, 0.4, 0}, 0.0, 0.0, "limits"},        {{0, 0, -1.1}, 0.0, 0.0, "limits"},
  };
  for (const Row& row : rows) {
    const CommandGuard::Verdict verdict =
        guard.judge(row.wanted, row.robot_age_s, row.objects_age_s);
    if (row.reason == nullptr) {
      EXPECT_EQ(verdict.reason, "");
      EXPECT_EQ(verdict.twist.vx_mps, row.wanted.vx_mps);
      EXPECT_EQ(verdict.twist.wz_rps, row.wanted.wz_rps);
    } else {
      EXPECT_NE(verdict.reason.find(row.reason), std::string::npos) << verdict.reason;
      EXPECT_EQ(verdict.twist.speed(), 0.0);
      EXPECT_EQ(verdict.twist.wz_rps, 0.0);
    }
  }
}

}  // namespace
}  // namespace casepush
