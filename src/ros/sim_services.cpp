#include <ros/ros.h>

#include <cmath>
#include <sstream>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/sim_node.h"

/// What others ask of the simulator: commands and services.
namespace casepush {
namespace {

constexpr std::uint32_t kMostSteps = 100000;  // Some seven minutes: a call should return.

// Also of the fields that a robot in the plane has no use for: whoever sends NaN has lost its way.
bool isFinite(const geometry_msgs::Twist& twist) {
  const double numbers[] = {twist.linear.x,  twist.linear.y,  twist.linear.z,
                            twist.angular.x, twist.angular.y, twist.angular.z};
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      return false;
    }
  }
  return true;
}

Twist2 planar(const geometry_msgs::Twist& twist) {
  return {twist.linear.x, twist.linear.y, twist.angular.z};
}

std::string faultOf(const geometry_msgs::Twist& message, const Simulator& simulator) {
  const std::string fault = simulator.commandFault(planar(message));
  if (fault.empty() && !isFinite(message)) {
    return "a field that is not used (linear.z, angular.x, angular.y) is not finite";
  }
  return fault;
}

}  // namespace

void SimNode::onCommand(const geometry_msgs::Twist& message) {
  const std::string fault = faultOf(message, simulator_);
  refused_commands_ += fault.empty() ? 0 : 1;
  if (!isFinite(message)) {
    ROS_WARN_THROTTLE(1.0, "cmd_vel is ignored: %s", fault.c_str());
    return;
  }
  if (!fault.empty()) {
    ROS_WARN_THROTTLE(1.0, "cmd_vel is clamped: %s", fault.c_str());
  }
  command(planar(message));
}

void SimNode::command(const Twist2& robot_twist) {
  simulator_.setCommand(robot_twist);
  command_arrived_ = true;
  commanded_to_move_ = robot_twist.speed() > 0.0 || robot_twist.wz_rps != 0.0;
  last_command_s_ = simulator_.time();
}

void SimNode::onObjects(const PushableObjectArray& message) {
  last_objects_s_ = message.header.stamp.toSec();
  images_seen_ = true;
}

bool SimNode::onStep(StepSimulation::Request& request, StepSimulation::Response& response) {
  try {
    if (!parameters_.lock_step) {
      throw InputError("sim/step", "time goes on by itself; start sim_node with lock_step: true");
    }
    if (request.steps > kMostSteps) {
      throw InputError("steps", "is " + std::to_string(request.steps) + ", must be at most " +
                                    std::to_string(kMostSteps));
    }
    if (request.has_command) {
      response.message = faultOf(request.command, simulator_);
      if (!isFinite(request.command)) {
        throw InputError("command", response.message);
      }
      command(planar(request.command));
    }
    advance(request.steps);
    publishClock();
    response.success = true;
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  response.clock = toRosTime(simulator_.time());
  response.step_count = static_cast<std::uint64_t>(simulator_.stepCount());
  return true;
}

bool SimNode::onReset(Reset::Request& request, Reset::Response& response) {
  simulator_.reset(request.seed);
  period_ = 0;
  last_command_s_ = -1e9;
  last_objects_s_ = -1e9;
  restartPacing();
  publishLoads();
  response.success = true;
  return true;
}

bool SimNode::onSetPoses(SetPoses::Request& request, SetPoses::Response& response) {
  try {
    std::map<std::string, Pose2> poses;
    for (const BodyPose& body : request.bodies) {
      if (!poses.emplace(body.id, fromMessage(body.pose)).second) {
        throw InputError("bodies", "two entries have the id " + body.id);
      }
    }
    simulator_.setPoses(poses);
    response.success = true;
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

bool SimNode::onSetLoad(SetLoad::Request& request, SetLoad::Response& response) {
  const std::string& id = request.load.id;
  try {
    simulator_.setLoad(id, fromMessage(request.load));
    response.load = toMessage(id, simulator_.load(id).value_or(Load()));
    response.success = true;
    publishLoads();
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

}  // namespace casepush
