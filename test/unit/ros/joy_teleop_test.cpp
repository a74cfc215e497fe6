#include "casepush/ros/joy_teleop.h"

#include <gtest/gtest.h>

#include <limits>

namespace casepush {
namespace {

TEST(JoyTeleop, scalesTheAxesThatAreMapped) {
  const JoyMapping mapping;
  const Twist2 twist = twistOf(mapping, {-1.0F, 1.0F, 0.9F, 0.5F});
  EXPECT_DOUBLE_EQ(twist.vx_mps, mapping.scale_x_mps);
  EXPECT_DOUBLE_EQ(twist.vy_mps, -mapping.scale_y_mps);
  EXPECT_NEAR(twist.wz_rps, mapping.scale_yaw_rps * (0.5 - 0.08) / 0.92, 1e-9);
}

TEST(JoyTeleop, smallDeflectionsAndNonsenseAreZero) {
  const JoyMapping mapping;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Twist2 twist = twistOf(mapping, {nan, 0.07F, 1.0F, -0.05F});
  EXPECT_EQ(twist.vx_mps, 0.0);
  EXPECT_EQ(twist.vy_mps, 0.0);
  EXPECT_EQ(twist.wz_rps, 0.0);
  EXPECT_EQ(twistOf(mapping, {0.0F, 7.0F}).vx_mps, mapping.scale_x_mps);
  EXPECT_EQ(twistOf(mapping, {}).vx_mps, 0.0);
}

TEST(JoyTeleop, anAxisCanBeLeftOut) {
  JoyMapping mapping;
  mapping.axis_y = -1;
  EXPECT_EQ(twistOf(mapping, {1.0F, 0.0F, 0.0F, 0.0F}).vy_mps, 0.0);
}

TEST(JoyTeleop, theDeadManButtonMustBeThereAndHeld) {
  const JoyMapping mapping;
  EXPECT_TRUE(isHeld(mapping, {0, 0, 0, 0, 1}));
  EXPECT_FALSE(isHeld(mapping, {1, 1, 1, 1, 0}));
  EXPECT_FALSE(isHeld(mapping, {1, 1}));
}

}  // namespace
}  // namespace casepush
