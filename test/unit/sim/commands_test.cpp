// Commands of the base: what is taken, clamped, ignored, and how long it lasts.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/driving.h"

namespace casepush {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(Models, SimulatorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

TEST_P(SimulatorModels, stopTheRobotAFifthOfASecondAfterTheLastOne) {
  Simulator simulator = makeSimulator(test::makeWorld(), 1, options());
  drive(simulator, {0.5, 0.0, 0.0}, 0.5);
  simulator.setCommand({0.5, 0.0, 0.0});
  simulator.step(48);  // 0.2 s
  EXPECT_NEAR(simulator.odometry().robot_twist.vx_mps, 0.5, 0.01);
  // From here on 40 kg are braked with 150 N: 0.133 s.
  simulator.step(16);
  EXPECT_NEAR(simulator.odometry().robot_twist.vx_mps, 0.25, 0.01);
  simulator.step(17);
  EXPECT_LT(simulator.odometry().robot_twist.speed(), 1e-6);
}

TEST_P(SimulatorModels, lastAsLongWhateverTheStep) {
  for (const double step_s : {1.0 / 100.0, 1.0 / 240.0, 1.0 / 960.0}) {
    SimulatorOptions with = options();
    with.step_s = step_s;
    with.command_timeout_s = 0.5;
    Simulator simulator = makeSimulator(test::makeWorld(), 1, with);
    simulator.setCommand({0.5, 0.0, 0.0});
    simulator.step(static_cast<int>(std::lround(0.5 / step_s)));
    EXPECT_NEAR(simulator.odometry().robot_twist.vx_mps, 0.5, 0.01) << step_s;
    simulator.step(1);
    EXPECT_LT(simulator.odometry().robot_twist.vx_mps, 0.499) << step_s;
  }
}

TEST_P(SimulatorModels, areIgnoredIfTheyAreNotFinite) {
  Simulator simulator = makeSimulator(test::makeWorld(), 1, options());
  EXPECT_TRUE(simulator.setCommand({0.3, 0.0, 0.0}));
  simulator.step(30);
  EXPECT_FALSE(simulator.setCommand({kNan, 0.0, 0.0}));
  EXPECT_FALSE(simulator.setCommand({0.0, kInfinity, 0.0}));
  EXPECT_FALSE(simulator.setCommand({0.0, 0.0, -kInfinity}));
  simulator.step(15);
  EXPECT_NEAR(simulator.odometry().robot_twist.vx_mps, 0.3, 0.01);
  simulator.step(45);  // They do not prolong the good one.
  EXPECT_LT(simulator.odometry().robot_twist.speed(), 1e-6);
}

TEST_P(SimulatorModels, areClampedToTheLimitsAndKeepTheirDirection) {
  Simulator simulator = makeSimulator(test::makeWorld(), 1, options());
  EXPECT_FALSE(simulator.setCommand({3.0, 4.0, -9.0}));
  simulator.step(47);
  const Twist2 twist = simulator.odometry().robot_twist;
  EXPECT_NEAR(twist.vx_mps, 0.3, 0.01);
  EXPECT_NEAR(twist.vy_mps, 0.4, 0.01);
  EXPECT_NEAR(twist.wz_rps, -1.0, 0.02);
  EXPECT_FALSE(simulator.setCommand({1e308, 1e308, 0.0}));
  simulator.step(47);
  EXPECT_LT(simulator.odometry().robot_twist.speed(), 0.51);
}

TEST(Commands, faultsNameValueAndBound) {
  const Simulator simulator = makeSimulator(test::makeWorld());
  EXPECT_EQ(simulator.commandFault({0.3, 0.4, -1.0}), "");
  EXPECT_EQ(simulator.commandFault({3.0, 4.0, 0.0}),
            "the speed is 5 m/s, above the limit of 0.5 m/s");
  EXPECT_EQ(simulator.commandFault({3.0, 4.0, -9.0}),
            "the speed is 5 m/s, above the limit of 0.5 m/s; the yaw rate is -9 rad/s, beyond the "
            "limit of 1 rad/s");
  EXPECT_EQ(simulator.commandFault({kNan, 0.0, kInfinity}),
            "(nan m/s, 0 m/s, inf rad/s) is not finite");
}

}  // namespace
}  // namespace casepush
