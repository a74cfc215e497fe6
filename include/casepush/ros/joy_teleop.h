#pragma once

#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/ros/parameter_reader.h"

namespace casepush {

/// Which axis and button of a joystick do what. Axes are numbered from 0; -1: none.
struct JoyMapping {
  int axis_x = 1;            ///< Forward.
  int axis_y = 0;            ///< To the left.
  int axis_yaw = 3;          ///< Turn left.
  double scale_x_mps = 0.3;  ///< At full deflection; negative turns an axis around.
  double scale_y_mps = 0.3;
  double scale_yaw_rps = 0.6;
  double dead_zone = 0.08;  ///< Of the deflection; beyond it, speed grows from 0.
  int dead_man_button = 4;  ///< Must be held.
};

/// The velocity that a joystick asks for; nothing deflected is zero. Axes that the joystick does
/// not have and values that are not finite count as not deflected.
Twist2 twistOf(const JoyMapping& mapping, const std::vector<float>& axes);

/// True if the dead-man button is held.
bool isHeld(const JoyMapping& mapping, const std::vector<std::int32_t>& buttons);

struct JoyTeleopParameters {
  JoyMapping mapping;
  double rate_hz = 20.0;
  double joy_timeout_s = 0.5;  ///< Age of the last `joy` (wall time) above which the robot stops.
};
JoyTeleopParameters loadJoyTeleopParameters(ParameterReader reader);

/// Turns `joy` into `teleop_cmd_vel` while the dead-man button is held, and one zero after it.
class JoyTeleop {
 public:
  JoyTeleop(JoyTeleopParameters parameters, ros::NodeHandle handle);

 private:
  void onJoy(const sensor_msgs::Joy& message);
  void publish();

  JoyTeleopParameters parameters_;
  sensor_msgs::Joy joy_;
  std::chrono::steady_clock::time_point received_;
  bool driving_ = false;
  ros::Publisher command_;
  ros::Subscriber subscriber_;
  ros::WallTimer timer_;
};

}  // namespace casepush
