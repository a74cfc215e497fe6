#include "range_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "casepush/model/catalog.h"
#include "casepush/sim/simulator.h"
#include "sim/scenes.h"

namespace casepush {
namespace {

/// Half a metre above the floor, level, in front of the robot's box.
RangeSensorModel makeSensor(int beams = 91, int layers = 1) {
  RangeSensorModel sensor;
  sensor.name = "scanner";
  sensor.base_T_sensor = test::at(0.3, 0.0, 0.4);
  sensor.beams = beams;
  sensor.layers = layers;
  sensor.horizontal_fov_rad = M_PI_2;
  sensor.rate_hz = 240.0;
  sensor.noise_m = 0.0;
  return sensor;
}

class RangeSensorModels : public testing::TestWithParam<CasterModel> {
 protected:
  static Simulator makeSimulator(const WorldModel& world, const RangeSensorModel& sensor,
                                 bool noise = false) {
    RobotModel robot = test::makeRobot();
    robot.range_sensors = {sensor};
    SimulatorOptions options;
    options.sensor_noise = noise;
    options.caster_model = GetParam();
    return Simulator(world, robot, {{"cart", test::makeCart()}}, options);
  }

  static RangeScan scan(const WorldModel& world, const RangeSensorModel& sensor,
                        bool noise = false) {
    Simulator simulator = makeSimulator(world, sensor, noise);
    simulator.setScanning(true);
    simulator.step();
    const auto scans = simulator.takeScans();
    EXPECT_EQ(scans.size(), 1U);
    return scans.at(0);
  }
};

INSTANTIATE_TEST_SUITE_P(Models, RangeSensorModels,
                         testing::Values(CasterModel::kFeatherstone, CasterModel::kPlanar),
                         [](const auto& model) { return std::string(toString(model.param)); });

WorldModel originWorld() {
  WorldModel world = test::makeWorld();
  world.map_T_robot = Pose2();
  return world;
}

TEST_P(RangeSensorModels, measureAWallWhereItIs) {
  WorldModel world = originWorld();
  world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, 3.1, 0.0));
  const RangeScan result = scan(world, makeSensor());
  ASSERT_EQ(result.points.size(), 91U);
  EXPECT_EQ(result.sensor, "scanner");
  for (int beam = 0; beam < 91; ++beam) {
    const Eigen::Vector3f& point = result.points[static_cast<std::size_t>(beam)];
    const double azimuth = (beam - 45) * M_PI / 180.0;
    EXPECT_NEAR(point.x(), 2.7, 2e-4);
    EXPECT_NEAR(point.y(), 2.7 * std::tan(azimuth), 4e-4);
    EXPECT_NEAR(point.z(), 0.0, 1e-6);
  }
}

TEST_P(RangeSensorModels, seeNothingBeyondTheirRangeNorBelowTheLeast) {
  WorldModel world = originWorld();
  world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, 3.1, 0.0));
  RangeSensorModel sensor = makeSensor(1);
  sensor.max_range_m = 2.6;
  EXPECT_TRUE(std::isnan(scan(world, sensor).points[0].x()));
  sensor.max_range_m = 2.8;
  EXPECT_FALSE(std::isnan(scan(world, sensor).points[0].x()));
  sensor.min_range_m = 2.75;
  EXPECT_TRUE(std::isnan(scan(world, sensor).points[0].x()));
}

TEST_P(RangeSensorModels, layersSpreadFromLowToHighAndMeetTheFloor) {
  RangeSensorModel sensor = makeSensor(1, 5);
  sensor.vertical_fov_rad = 40.0 * M_PI / 180.0;
  const RangeScan result = scan(originWorld(), sensor);
  for (int layer = 0; layer < 2; ++layer) {
    const double down = (20.0 - 10.0 * layer) * M_PI / 180.0;
    const Eigen::Vector3f& point = result.points[static_cast<std::size_t>(layer)];
    EXPECT_NEAR(point.z(), -0.4, 1e-6);
    EXPECT_NEAR(point.x(), 0.4 / std::tan(down), 1e-5);
  }
  for (std::size_t layer = 2; layer < 5; ++layer) {
    EXPECT_TRUE(std::isnan(result.points[layer].x())) << layer;
  }
}

TEST_P(RangeSensorModels, furnitureHidesWhatIsBehind) {
  WorldModel world = test::makeCartWorld(Pose2(2.0, 0.0, 0.0));
  world.map_T_robot = Pose2();
  world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, 5.1, 0.0));
  RangeSensorModel sensor = makeSensor();
  const RangeScan at_the_body = scan(world, sensor);
  EXPECT_NEAR(at_the_body.points[45].x(), 2.0 - 0.3 - 0.3, 2e-3);
  EXPECT_NEAR(at_the_body.points[65].x(), 4.7, 1e-3);
  // Below the cart's body, which is 12 cm above the floor.
  sensor.base_T_sensor = test::at(0.3, 0.0, 0.1);
  EXPECT_NEAR(scan(world, sensor).points[45].x(), 4.7, 1e-3);
}

// The planar model moves no bodies for wheels; they are seen all the same.
TEST_P(RangeSensorModels, wheelsOfTheShippedChairAreSeen) {
  const Catalog catalog = Catalog::standard();
  WorldModel world = test::makeWorld();
  world.map_T_robot = Pose2();
  world.objects.push_back({"chair_1", "office_chair", Pose2(1.5, 0.0, 0.0), 0});
  RobotModel robot = test::makeRobot();
  RangeSensorModel sensor = makeSensor(361);
  sensor.base_T_sensor = test::at(0.3, 0.0, 0.015);  // Forks end above.
  robot.range_sensors = {sensor};
  SimulatorOptions options;
  options.caster_model = GetParam();
  Simulator simulator(world, robot, {{"office_chair", catalog.object("office_chair")}}, options);
  simulator.setScanning(true);
  simulator.step();
  int seen = 0;
  const std::vector<RangeScan> scans = simulator.takeScans();
  for (const Eigen::Vector3f& point : scans.at(0).points) {
    if (std::isnan(point.x())) continue;
    EXPECT_NEAR(std::hypot(point.x() - 1.2, point.y()), 0.3, 0.15);
    ++seen;
  }
  EXPECT_GT(seen, 10);
}

TEST_P(RangeSensorModels, theRobotItselfHidesThingsAndIsLeftOut) {
  WorldModel world = originWorld();
  world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, -3.1, 0.0));
  RangeSensorModel sensor = makeSensor(360);
  sensor.horizontal_fov_rad = 2.0 * M_PI;
  const RangeScan result = scan(world, sensor);
  EXPECT_TRUE(std::isnan(result.points[0].x())) << "backwards, through the robot's box";
  sensor.base_T_sensor = test::at(0.3, 0.0, 0.8);  // Above the box, beside the mast.
  EXPECT_TRUE(std::isnan(scan(world, sensor).points[0].x()));
  EXPECT_NEAR(scan(world, sensor).points[15].x(), -3.3, 1e-3);
}

TEST_P(RangeSensorModels, noiseGrowsWithRangeAsTheModelSays) {
  for (const double range_m : {1.0, 5.0}) {
    WorldModel world = originWorld();
    world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, 0.4 + range_m, 0.0));
    RangeSensorModel sensor = makeSensor(5000);
    sensor.horizontal_fov_rad = 0.0;  // All beams look the same way.
    sensor.noise_m = 0.01;
    sensor.noise_per_range = 0.004;
    const RangeScan result = scan(world, sensor, true);
    double sum = 0.0;
    double squares = 0.0;
    for (const Eigen::Vector3f& point : result.points) {
      const double error_m = static_cast<double>(point.x()) - range_m;
      sum += error_m;
      squares += error_m * error_m;
    }
    const double sigma_m = 0.01 + 0.004 * range_m;
    EXPECT_NEAR(sum / 5000.0, 0.0, 4.0 * sigma_m / std::sqrt(5000.0) + 1e-4);
    EXPECT_NEAR(std::sqrt(squares / 5000.0), sigma_m, 0.05 * sigma_m);
  }
}

TEST_P(RangeSensorModels, beamsDropOutAsOftenAsTheModelSays) {
  WorldModel world = originWorld();
  world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, 3.1, 0.0));
  RangeSensorModel sensor = makeSensor(5000);
  sensor.dropout = 0.2;
  const auto dropped = [&](bool noise) {
    int count = 0;
    const RangeScan result = scan(world, sensor, noise);
    for (const Eigen::Vector3f& point : result.points) {
      count += std::isnan(point.x()) ? 1 : 0;
    }
    return count;
  };
  EXPECT_NEAR(dropped(true), 1000, 115);  // Four standard deviations.
  EXPECT_EQ(dropped(false), 0);
  sensor.switches.noise = false;
  EXPECT_EQ(dropped(true), 0);
}

TEST_P(RangeSensorModels, comeAtTheirRateAfterTheirLatency) {
  RangeSensorModel sensor = makeSensor(3);
  sensor.rate_hz = 10.0;
  sensor.latency_s = 0.05;
  Simulator simulator = makeSimulator(originWorld(), sensor);
  simulator.setScanning(true);
  int scans = 0;
  for (int i = 0; i < 480; ++i) {
    simulator.step();
    for (const RangeScan& result : simulator.takeScans()) {
      EXPECT_NEAR(simulator.time() - result.stamp_s, 0.05, 1e-9);
      ++scans;
    }
  }
  EXPECT_NEAR(scans, 20, 1);
}

TEST_P(RangeSensorModels, measureOnlyWhatIsWantedAndThenWithTheSameNoise) {
  WorldModel world = originWorld();
  world.boxes.push_back(test::makeBox("wall", {0.2, 20.0, 1.0}, 3.1, 0.0));
  RangeSensorModel sensor = makeSensor(20);
  sensor.noise_m = 0.05;
  sensor.rate_hz = 24.0;
  Simulator always = makeSimulator(world, sensor, true);
  always.setScanning(true);
  always.step(240);
  const auto all = always.takeScans();
  ASSERT_EQ(all.size(), 25U);
  Simulator late = makeSimulator(world, sensor, true);
  late.step(200);
  EXPECT_TRUE(late.takeScans().empty());
  late.setScanning(true);
  late.step(40);
  const auto some = late.takeScans();
  ASSERT_EQ(some.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(some[i].stamp_s, all[21 + i].stamp_s);
    EXPECT_EQ(some[i].points, all[21 + i].points);
  }
  EXPECT_NE(all[0].points, all[1].points);
}

TEST_P(RangeSensorModels, areNotThereWhenDisabled) {
  RangeSensorModel sensor = makeSensor();
  sensor.switches.enabled = false;
  Simulator simulator = makeSimulator(originWorld(), sensor);
  simulator.setScanning(true);
  simulator.step(100);
  EXPECT_TRUE(simulator.takeScans().empty());
}

}  // namespace
}  // namespace casepush
