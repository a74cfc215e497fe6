#include "casepush/model/robot_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/input_error_text.h"
#include "common/temporary_folder.h"
#include "model/small_models.h"

namespace casepush {
namespace {

class LoadRobotModel : public testing::Test {
 protected:
  RobotModel load(const std::string& urdf, const std::string& yaml) {
    folder_.write("bot.yaml", yaml);
    return loadRobotModel(folder_.write("bot.urdf", urdf));
  }

  std::string yamlError(const std::string& from, const std::string& to) {
    const std::string text =
        inputErrorText([&] { load(smallRobotUrdf(), replaced(smallRobotYaml(), from, to)); });
    const std::string prefix = (folder_.path() / "bot.yaml: ").string();
    return text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
  }

  TemporaryFolder folder_;
};

TEST_F(LoadRobotModel, readsLimitsSolidAndCameras) {
  const RobotModel bot = load(smallRobotUrdf(), smallRobotYaml());
  EXPECT_EQ(bot.name, "bot");
  EXPECT_EQ(bot.limits.max_force_n, 150.0);
  EXPECT_EQ(bot.limits.max_yaw_acceleration_rps2, 2.0);
  ASSERT_EQ(bot.solid.size(), 1U);
  EXPECT_EQ(bot.solid[0].part, "base_link");
  EXPECT_NEAR(bot.radius_m, 0.3, 1e-5);
  ASSERT_EQ(bot.cameras.size(), 1U);
  const CameraModel& camera = bot.cameras[0];
  EXPECT_EQ(camera.name, "left");
  EXPECT_NEAR(camera.horizontal_fov_rad, M_PI / 2, 1e-12);
  EXPECT_NEAR(camera.focalPx(), 320.0, 1e-9);
  EXPECT_NEAR(camera.max_view_angle_rad, 70.0 * M_PI / 180.0, 1e-12);
}

TEST_F(LoadRobotModel, readsSurfaceFriction) {
  EXPECT_EQ(load(smallRobotUrdf(), smallRobotYaml()).surface_friction, 0.6);
  EXPECT_EQ(load(smallRobotUrdf(), smallRobotYaml() + "surface_friction: 1.1\n").surface_friction,
            1.1);
}

TEST_F(LoadRobotModel, turnsTheHousingIntoTheOpticalFrame) {
  const CameraModel camera = load(smallRobotUrdf(), smallRobotYaml()).cameras[0];
  const Eigen::Matrix3d rotation = camera.base_T_camera.linear();
  const double c = std::cos(M_PI / 6);
  const double s = std::sin(M_PI / 6);
  // Looking left (+y) and 30 degrees down.
  EXPECT_LT((rotation.col(2) - Eigen::Vector3d(0, c, -s)).norm(), 1e-12) << "forward";
  EXPECT_LT((rotation.col(0) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12) << "right";
  EXPECT_LT((rotation.col(1) - Eigen::Vector3d(0, -s, -c)).norm(), 1e-12) << "down";
  EXPECT_EQ(camera.base_T_camera.translation(), Eigen::Vector3d(0, 0.3, 0.5));
}

TEST_F(LoadRobotModel, refusesMovingJoints) {
  std::string urdf = smallCartUrdf();
  EXPECT_EQ(inputErrorText([&] { load(urdf, smallRobotYaml()); }),
            (folder_.path() / "bot.urdf").string() +
                ": joint 'fixed_axle': moves; a robot's joints must all be fixed");
}

TEST_F(LoadRobotModel, refusesARobotWithoutShape) {
  std::string urdf = smallRobotUrdf();
  const std::string end = "</collision>";
  urdf.erase(urdf.find("<collision>"), urdf.find(end) + end.size() - urdf.find("<collision>"));
  EXPECT_EQ(inputErrorText([&] { load(urdf, smallRobotYaml()); }),
            (folder_.path() / "bot.urdf").string() + ": has no collision shapes");
}

TEST_F(LoadRobotModel, refusesHugeNumbers) {
  for (const char* key :
       {"max_speed_mps: 0.5", "max_yaw_rate_rps: 1.0", "max_acceleration_mps2: 0.8",
        "max_yaw_acceleration_rps2: 2.0", "max_force_n: 150", "max_torque_nm: 40", "width_px: 640",
        "height_px: 480", "horizontal_fov_deg: 90", "rate_hz: 15", "latency_s: 0.05",
        "max_range_m: 5", "max_view_angle_deg: 70", "corner_noise_px: 0.3"}) {
    const std::string name(key, std::string(key).find(':') + 2);
    EXPECT_NE(yamlError(key, name + "1e6").find("is 1e+06; must be a number in ["),
              std::string::npos)
        << key;
  }
  EXPECT_EQ(yamlError("xyz: [0, 0.3, 0.5]", "xyz: [0, 1e300, 0.5]"),
            "cameras[0].xyz: holds 1e+300; each must be within 10 m of 0");
}

TEST_F(LoadRobotModel, refusesBadYaml) {
  EXPECT_EQ(yamlError("max_force_n: 150", "max_force_n: 0"),
            "limits.max_force_n: is 0; must be a number in [1, 5000]");
  EXPECT_EQ(yamlError("  max_torque_nm: 40\n", ""),
            "limits.max_torque_nm: is missing; must be a number in [0.1, 5000]");
  EXPECT_EQ(yamlError("max_torque_nm: 40", "max_torque_nm: 40\n  max_jerk: 1"),
            "limits: unknown key(s): max_jerk");
  EXPECT_EQ(yamlError("dropout: 0.02", "dropout: 1.5"),
            "cameras[0].dropout: is 1.5; must be a number in [0, 1]");
  EXPECT_EQ(yamlError("dropout: 0.02", "dropout: 0.02\n    lens: wide"),
            "cameras[0]: unknown key(s): lens");
  EXPECT_EQ(yamlError("horizontal_fov_deg: 90", "horizontal_fov_deg: 180"),
            "cameras[0].horizontal_fov_deg: is 180; must be a number in [1, 170]");
  const std::string yaml = smallRobotYaml();
  const std::string camera = yaml.substr(yaml.find("  - name"));
  EXPECT_EQ(yamlError(camera, camera + camera), "cameras[1].name: left is taken by another sensor");
  EXPECT_EQ(yamlError("cameras:\n" + camera, ""), "cameras: must list at least one camera");
}

constexpr char kScanner[] = R"(range_sensors:
  - name: scanner
    xyz: [0.4, 0, 0.3]
    rpy_deg: [0, 0, 0]
    beams: 181
    horizontal_fov_deg: 180
    max_range_m: 8
    rate_hz: 10
    noise_m: 0.02
)";

TEST_F(LoadRobotModel, readsRangeSensorsOdometryAndLocalisation) {
  const RobotModel bot =
      load(smallRobotUrdf(), smallRobotYaml() + kScanner +
                                 "odometry: {noise: false, yaw_per_turn_deg: 3}\n"
                                 "localisation: {position_sigma_m: 0.01, seed: 4}\n");
  ASSERT_EQ(bot.range_sensors.size(), 1U);
  const RangeSensorModel& scanner = bot.range_sensors[0];
  EXPECT_TRUE(scanner.switches.enabled && scanner.switches.noise);
  EXPECT_EQ(scanner.layers, 1);
  EXPECT_EQ(scanner.dropout, 0.0);
  EXPECT_LT((scanner.direction(0, 0) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
  EXPECT_LT((scanner.direction(0, 90) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((scanner.direction(0, 180) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_FALSE(bot.odometry.switches.noise);
  EXPECT_NEAR(bot.odometry.yaw_per_turn_rad, 3.0 * M_PI / 180.0, 1e-12);
  EXPECT_EQ(bot.localisation.switches.seed, 4U);
  EXPECT_DOUBLE_EQ(bot.localisation.position_bound_m, 0.03);  // Three standard deviations.
}

TEST_F(LoadRobotModel, refusesBadSensors) {
  const auto error = [&](const std::string& from, const std::string& to) {
    const std::string text = inputErrorText(
        [&] { load(smallRobotUrdf(), smallRobotYaml() + replaced(kScanner, from, to)); });
    return text.substr(text.find("range_sensors"));
  };
  EXPECT_EQ(error("noise_m: 0.02", "noise_m: -1"),
            "range_sensors[0].noise_m: is -1; must be a number in [0, 1]");
  EXPECT_EQ(error("beams: 181", "beams: 181\n    beans: 3"),
            "range_sensors[0]: unknown key(s): beans");
  EXPECT_EQ(error("name: scanner", "name: left"),
            "range_sensors[0].name: left is taken by another sensor");
  EXPECT_EQ(error("name: scanner", "name: odometry"),
            "range_sensors[0].name: odometry is taken by another sensor");
  EXPECT_EQ(error("xyz: [0.4", "xyz: [0.1"),
            "range_sensors[0].xyz: (0.1, 0, 0.3) is inside the robot's base_link, where it sees "
            "nothing; must be outside");
  EXPECT_EQ(
      error("beams: 181", "beams: 10000\n    layers: 100"),
      "range_sensors[0]: casts 1000000 rays a scan and 1e+07 a second; must be at most 200000 "
      "and 2e+06: use fewer beams or layers, or a lower rate");
  EXPECT_EQ(error("max_range_m: 8", "max_range_m: 8\n    min_range_m: 9"),
            "range_sensors[0].min_range_m: is 9; must be a number in [0, 8]");
  const auto section = [&](const std::string& text) {
    const std::string message =
        inputErrorText([&] { load(smallRobotUrdf(), smallRobotYaml() + text); });
    return message.substr(message.find("yaml: ") + 6);
  };
  EXPECT_EQ(section("odometry: {scale: 2}\n"),
            "odometry.scale: is 2; must be a number in [0, 0.1]");
  EXPECT_EQ(section("odometry: {enabled: false}\n"), "odometry: unknown key(s): enabled");
  EXPECT_EQ(section("localisation: {correlation_s: 0}\n"),
            "localisation.correlation_s: is 0; must be a number in [0.001, 1e+06]");
}

}  // namespace
}  // namespace casepush
