#include "casepush/ros/joy_teleop.h"

#include <geometry_msgs/Twist.h>

#include <algorithm>
#include <cmath>

#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr int kMostAxes = 64;

double deflection(const JoyMapping& mapping, const std::vector<float>& axes, int axis) {
  if (axis < 0 || axis >= static_cast<int>(axes.size()) || !std::isfinite(axes[axis])) {
    return 0.0;
  }
  const double value = std::clamp<double>(axes[axis], -1.0, 1.0);
  const double beyond = std::max(0.0, std::abs(value) - mapping.dead_zone);
  return std::copysign(beyond / (1.0 - mapping.dead_zone), value);
}

}  // namespace

Twist2 twistOf(const JoyMapping& mapping, const std::vector<float>& axes) {
  return {mapping.scale_x_mps * deflection(mapping, axes, mapping.axis_x),
          mapping.scale_y_mps * deflection(mapping, axes, mapping.axis_y),
          mapping.scale_yaw_rps * deflection(mapping, axes, mapping.axis_yaw)};
}

bool isHeld(const JoyMapping& mapping, const std::vector<std::int32_t>& buttons) {
  const auto button = static_cast<std::size_t>(mapping.dead_man_button);
  return button < buttons.size() && buttons[button] == 1;
}

JoyTeleopParameters loadJoyTeleopParameters(ParameterReader reader) {
  JoyTeleopParameters parameters;
  JoyMapping& mapping = parameters.mapping;
  reader.read("axis_x", mapping.axis_x, -1, kMostAxes);
  reader.read("axis_y", mapping.axis_y, -1, kMostAxes);
  reader.read("axis_yaw", mapping.axis_yaw, -1, kMostAxes);
  reader.read("scale_x", mapping.scale_x_mps, -5.0, 5.0);
  reader.read("scale_y", mapping.scale_y_mps, -5.0, 5.0);
  reader.read("scale_yaw", mapping.scale_yaw_rps, -10.0, 10.0);
  reader.read("dead_zone", mapping.dead_zone, 0.0, 0.9);
  reader.read("dead_man_button", mapping.dead_man_button, 0, kMostAxes);
  reader.read("rate", parameters.rate_hz, 5.0, 100.0);
  reader.read("joy_timeout", parameters.joy_timeout_s, 0.05, 5.0);
  reader.finish();
  return parameters;
}

JoyTeleop::JoyTeleop(JoyTeleopParameters parameters, ros::NodeHandle handle)
    : parameters_(parameters),
      command_(handle.advertise<geometry_msgs::Twist>(names::kTeleopVelocity.name,
                                                      names::kTeleopVelocity.queue_size)),
      subscriber_(handle.subscribe(names::kJoy.name, names::kJoy.queue_size, &JoyTeleop::onJoy,
                                   this, ros::TransportHints().tcpNoDelay())),
      timer_(handle.createWallTimer(ros::WallDuration(1.0 / parameters.rate_hz),
                                    [this](const ros::WallTimerEvent&) { publish(); })) {}

void JoyTeleop::onJoy(const sensor_msgs::Joy& message) {
  joy_ = message;
  received_ = std::chrono::steady_clock::now();
  if (driving_ && !isHeld(parameters_.mapping, joy_.buttons)) {
    publish();  // Letting go stops at once.
  }
}

void JoyTeleop::publish() {
  const double age_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - received_).count();
  const bool driving =
      age_s <= parameters_.joy_timeout_s && isHeld(parameters_.mapping, joy_.buttons);
  if (driving || driving_) {
    command_.publish(toMessage(driving ? twistOf(parameters_.mapping, joy_.axes) : Twist2{}));
  }
  driving_ = driving;
}

}  // namespace casepush
