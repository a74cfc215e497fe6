#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>

#include "casepush/common/input_error.h"
#include "casepush/sim/simulator.h"
#include "sim/scenes.h"

/// What tests of the simulator's interface share: making one, driving, hashing what it shows.
namespace casepush {

inline Simulator makeSimulator(const WorldModel& world, std::uint64_t seed = 1,
                               const SimulatorOptions& base = {}) {
  SimulatorOptions options = base;
  options.seed = seed;
  RobotModel robot = test::makeRobot();
  robot.cameras.push_back(test::makeCamera());
  robot.odometry.switches.noise = false;  // Tests ask it for the robot's velocity.
  robot.range_sensors.push_back(test::makeScanner());
  return Simulator(world, robot, {{"cart", test::makeCart()}, {"crate", test::makeCrate()}},
                   options);
}

// Drives for a time, renewing the command as a node would.
inline void drive(Simulator& simulator, const Twist2& twist, double duration_s) {
  const int ticks = static_cast<int>(std::lround(duration_s * 48.0));
  for (int i = 0; i < ticks; ++i) {
    simulator.setCommand(twist);
    simulator.step(static_cast<int>(std::lround(1.0 / (48.0 * simulator.stepSeconds()))));
  }
}

inline void mix(std::uint64_t& hash, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  hash = (hash ^ bits) * 0x100000001b3ULL;
}

template <typename Matrix>
void mixAll(std::uint64_t& hash, const Matrix& matrix) {
  for (int i = 0; i < matrix.size(); ++i) mix(hash, matrix(i % matrix.rows(), i / matrix.rows()));
}

constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ULL;

// FNV over everything that a caller can see, down to the last bit. Takes images, scans and
// contacts.
inline std::uint64_t hashOf(Simulator& simulator, std::uint64_t hash = kHashStart) {
  const OdometryReading odometry = simulator.odometry();
  for (const Pose2& pose :
       {simulator.trueRobotPose(), odometry.map_T_odom, odometry.odom_T_robot}) {
    for (const double value : {pose.x(), pose.y(), pose.yaw()}) mix(hash, value);
  }
  for (const double value : {simulator.time(), odometry.robot_twist.vx_mps,
                             odometry.robot_twist.vy_mps, odometry.robot_twist.wz_rps}) {
    mix(hash, value);
  }
  for (const ObjectPlacement& object : simulator.world().objects) {
    for (const Eigen::Isometry3d& pose : simulator.trueLinkPoses(object.id)) {
      mixAll(hash, pose.matrix());
    }
  }
  for (const TagFrame& frame : simulator.takeTagFrames()) {
    mix(hash, frame.stamp_s);
    for (const TagDetection& tag : frame.detections) {
      mixAll(hash, tag.camera_T_tag.matrix());
      mixAll(hash, tag.covariance);
    }
  }
  for (const RangeScan& scan : simulator.takeScans()) {
    mix(hash, scan.stamp_s);
    for (const Eigen::Vector3f& point : scan.points) mixAll(hash, point);
  }
  for (const ContactReport& contact : simulator.takeContacts()) {
    mix(hash, contact.impulse_ns);
    mixAll(hash, contact.map_point);
  }
  return hash;
}

inline void expectInputError(const std::function<void()>& action, const std::string& text) {
  try {
    action();
    FAIL() << "no error; expected: " << text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

/// Every model of casters has to keep the simulator's promises.
class SimulatorModels : public testing::TestWithParam<CasterModel> {
 protected:
  static SimulatorOptions options() {
    SimulatorOptions result;
    result.caster_model = GetParam();
    return result;
  }
};

}  // namespace casepush
