// Switching or seeding one sensor changes neither the physics nor what another sensor reports.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <string>

#include "casepush/common/input_error.h"
#include "casepush/sim/simulator.h"
#include "sim/scenes.h"

namespace casepush {
namespace {

using Hashes = std::map<std::string, std::uint64_t>;

void mix(std::uint64_t& hash, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  hash = (hash ^ bits) * 0x100000001b3ULL;
}

void mixPose(std::uint64_t& hash, const Pose2& pose) {
  for (const double value : {pose.x(), pose.y(), pose.yaw()}) mix(hash, value);
}

RobotModel makeRobot() {
  RobotModel robot = test::makeRobot();
  robot.cameras = {test::makeCamera(), test::makeCamera()};
  robot.cameras[1].name = "second";
  robot.cameras[1].rate_hz = 13.0;
  for (CameraModel& camera : robot.cameras) camera.dropout = 0.1;
  RangeSensorModel scanner;
  scanner.name = "scanner";
  scanner.base_T_sensor = test::at(0.3, 0.0, 0.4);
  scanner.beams = 60;
  scanner.dropout = 0.1;
  robot.range_sensors = {scanner};
  return robot;
}

/// Drives into the cart and hashes, by sensor, all that is reported on the way, and the truth.
Hashes run(const std::function<void(RobotModel&, SimulatorOptions&)>& change,
           bool scanning = true) {
  RobotModel robot = makeRobot();
  SimulatorOptions options;
  change(robot, options);
  Simulator simulator(test::makeCartWorld(Pose2(0.0, 0.0, M_PI - 0.3)), robot,
                      {{"cart", test::makeCart()}}, options);
  simulator.setScanning(scanning);
  Hashes hashes;
  for (int i = 0; i < 240; ++i) {
    simulator.setCommand({0.45, 0.02, 0.05});
    simulator.step(5);
    const OdometryReading reading = simulator.odometry();
    mixPose(hashes["odometry"], reading.odom_T_robot);
    mix(hashes["odometry"], reading.robot_twist.vx_mps);
    // Apart from rounding, the error of the estimate is localisation's alone.
    const Pose2 estimate = reading.map_T_odom * reading.odom_T_robot;
    mix(hashes["localisation"], std::round(1e9 * (estimate.x() - simulator.trueRobotPose().x())));
    mixPose(hashes["physics"], simulator.trueRobotPose());
    mixPose(hashes["physics"], simulator.trueObjectPose("cart_1"));
    for (const TagFrame& frame : simulator.takeTagFrames()) {
      mix(hashes[frame.camera], frame.stamp_s);
      for (const TagDetection& tag : frame.detections) {
        mix(hashes[frame.camera], tag.camera_T_tag(2, 3));
      }
    }
    for (const RangeScan& scan : simulator.takeScans()) {
      for (const Eigen::Vector3f& point : scan.points) mix(hashes[scan.sensor], point.x());
    }
  }
  return hashes;
}

/// Names of those that differ.
std::string changed(const Hashes& before, const Hashes& after) {
  std::string names;
  for (const auto& [name, hash] : before) {
    const auto found = after.find(name);
    if (found == after.end() || found->second != hash) names += name + " ";
  }
  return names;
}

class SensorIndependence : public testing::Test {
 protected:
  const Hashes reference_ = run([](RobotModel&, SimulatorOptions&) {});
};

TEST_F(SensorIndependence, allRepeatThemselvesBitByBit) {
  EXPECT_EQ(changed(reference_, run([](RobotModel&, SimulatorOptions&) {})), "");
}

TEST_F(SensorIndependence, takingASensorAwayChangesNoOther) {
  for (const std::string name : {"front", "second", "scanner"}) {
    const auto disable = [&](RobotModel& robot, SimulatorOptions&) { disableSensor(robot, name); };
    EXPECT_EQ(changed(reference_, run(disable)), name + " ");
  }
}

TEST_F(SensorIndependence, makingASensorExactChangesNoOther) {
  for (const std::string name : {"front", "second", "scanner", "odometry", "localisation"}) {
    const auto exact = [&](RobotModel& robot, SimulatorOptions&) { makeSensorExact(robot, name); };
    EXPECT_EQ(changed(reference_, run(exact)), name + " ");
  }
}

TEST_F(SensorIndependence, seedsAndSwitchesOfAllSensorsLeaveThePhysics) {
  const auto seed = [](RobotModel& robot, SimulatorOptions&) {
    robot.cameras[0].switches.seed = 7;
    robot.odometry.switches.seed = 7;
  };
  EXPECT_EQ(changed(reference_, run(seed)), "front odometry ");
  const auto exact = [](RobotModel&, SimulatorOptions& options) { options.sensor_noise = false; };
  EXPECT_EQ(changed(reference_, run(exact)), "front localisation odometry scanner second ");
  EXPECT_EQ(changed(reference_, run([](RobotModel&, SimulatorOptions&) {}, false)), "scanner ");
}

TEST_F(SensorIndependence, aSeedOfItsOwnOutlivesTheSimulators) {
  const auto seeded = [](std::uint64_t simulator_seed) {
    return run([=](RobotModel& robot, SimulatorOptions& options) {
      robot.odometry.switches.seed = 7;
      robot.localisation.switches.seed = 9;
      options.seed = simulator_seed;
      robot.cameras.clear();
      robot.range_sensors.clear();
    });
  };
  // Swivels differ, and with them the way of the cart and of the robot that pushes it.
  EXPECT_EQ(changed(seeded(1), seeded(2)).find("localisation"), std::string::npos);
}

TEST(SensorNames, areChecked) {
  RobotModel robot = makeRobot();
  const auto errorOf = [&](void (*change)(RobotModel&, const std::string&), const char* name) {
    try {
      change(robot, name);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(errorOf(disableSensor, "lidar"),
            "robot pusher: has no sensor 'lidar'; there are front, second, scanner, odometry, "
            "localisation");
  EXPECT_NE(errorOf(disableSensor, "odometry").find("cannot be disabled"), std::string::npos);
  EXPECT_NE(errorOf(makeSensorExact, "lidar").find("has no sensor"), std::string::npos);
}

}  // namespace
}  // namespace casepush
