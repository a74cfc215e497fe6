// How ExecutorNode lets a person drive, and notices who else drives.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "casepush/ros/conversions.h"
#include "casepush/ros/executor_node.h"

namespace casepush {
namespace {

/// As wanted, slower if it must be; the direction stays.
Twist2 withinLimits(const Twist2& wanted, const RobotLimits& limits) {
  const double share = std::max({1.0, wanted.speed() / limits.max_speed_mps,
                                 std::abs(wanted.wz_rps) / limits.max_yaw_rate_rps});
  return {wanted.vx_mps / share, wanted.vy_mps / share, wanted.wz_rps / share};
}

}  // namespace

std::string ExecutorNode::whoIsBusy() const {
  if (activity_ != nullptr) {
    return activity_->describe();
  }
  return teleop_ ? "driven by hand" : "";
}

void ExecutorNode::onTeleop(const geometry_msgs::Twist& message) {
  if (activity_ != nullptr) {
    ROS_WARN_THROTTLE(1.0, "teleop_cmd_vel is ignored: %s; call the service stop first",
                      activity_->describe().c_str());
    return;
  }
  const Twist2 wanted{message.linear.x, message.linear.y, message.angular.z};
  if (!wanted.isFinite()) {
    ROS_WARN_THROTTLE(1.0, "teleop_cmd_vel is not finite: the base is told to stand");
  }
  const Twist2 safe =
      wanted.isFinite() ? withinLimits(wanted, parameters_.furnishing.robot.limits) : Twist2{};
  command_.publish(toMessage(safe));
  last_teleop_ = SteadyClock::now();
  if (!teleop_) {
    teleop_ = true;
    publishState(last_stamp_s_);
  }
}

void ExecutorNode::checkTeleop() {
  const double silent_s = std::chrono::duration<double>(SteadyClock::now() - last_teleop_).count();
  if (teleop_ && silent_s > parameters_.teleop_timeout_s) {
    teleop_ = false;
    command_.publish(geometry_msgs::Twist());
    publishState(last_stamp_s_);
  }
}

void ExecutorNode::onCommand(const ros::MessageEvent<const geometry_msgs::Twist>& event) {
  if (event.getPublisherName() == ros::this_node::getName()) {
    return;
  }
  foreign_commander_ = event.getPublisherName();
  foreign_command_s_ = ros::SteadyTime::now().toSec();
  ROS_ERROR_THROTTLE(5.0, "cmd_vel: %s commands the base, too; only executor_node may",
                     foreign_commander_.c_str());
}

}  // namespace casepush
