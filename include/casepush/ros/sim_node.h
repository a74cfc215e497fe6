#pragma once

#include <casepush/ObjectLoadArray.h>
#include <casepush/PushableObjectArray.h>
#include <casepush/Reset.h>
#include <casepush/SetLoad.h>
#include <casepush/SetPoses.h>
#include <casepush/StepSimulation.h>
#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>

#include "casepush/ros/diagnostics.h"
#include "casepush/ros/node_parameters.h"
#include "casepush/sim/simulator.h"

namespace casepush {

/// Static transforms base_link -> frame of each camera (optical) and range sensor.
std::vector<geometry_msgs::TransformStamped> sensorTransforms(const RobotModel& robot);

/// The bundled simulator behind the interface of a robot: /clock, odom, TF, tag detections, points.
///
/// Everything happens in one thread: a control period of simulation, then callbacks. With
/// real_time_factor 0 the next period begins as soon as a command has come, or when none came
/// within a while; so a controller that commands once per period stays in step with the world.
/// With lock_step time stands still but for the service sim/step. All modes take the same steps and
/// publish at the same simulated times; they differ in when they take the next one.
class SimNode {
 public:
  /// @throws InputError from the simulator.
  SimNode(SimNodeParameters parameters, ros::NodeHandle handle);

  /// Runs until ROS shuts down or max_sim_time_s is over.
  void run();

 private:
  using SteadyClock = std::chrono::steady_clock;

  std::int64_t stepsToPeriodEnd() const;
  void advance(std::int64_t steps);
  void standStill();
  void publishPeriod();
  void publishClock();
  void publishMotion();
  void publishSensors();
  void publishTruth();
  void publishSurvey();
  void publishLoads();
  void waitForNodes();
  bool isCommanded() const;
  bool nodesKeepUp(SteadyClock::time_point rested) const;
  void restartPacing();

  void onObjects(const PushableObjectArray& message);
  void onCommand(const geometry_msgs::Twist& message);
  void command(const Twist2& robot_twist);
  bool onStep(StepSimulation::Request& request, StepSimulation::Response& response);
  bool onReset(Reset::Request& request, Reset::Response& response);
  bool onSetPoses(SetPoses::Request& request, SetPoses::Response& response);
  bool onSetLoad(SetLoad::Request& request, SetLoad::Response& response);
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  SimNodeParameters parameters_;
  Simulator simulator_;
  ros::NodeHandle handle_;
  ros::Publisher clock_;
  ros::Publisher odometry_;
  ros::Publisher tags_;
  ros::Publisher true_objects_;
  ros::Publisher true_loads_;
  ros::Publisher contacts_;
  ros::Publisher points_;
  ros::Publisher survey_;
  ros::Subscriber command_;
  ros::Subscriber objects_;
  ros::ServiceServer reset_;
  ros::ServiceServer set_poses_;
  ros::ServiceServer set_load_;
  ros::ServiceServer step_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;

  std::int64_t period_ = 0;  ///< Control periods that are over since the start or reset.
  bool command_arrived_ = false;
  bool images_seen_ = false;  ///< Tracked poses have come since the last images.
  bool commanded_to_move_ = false;
  double last_command_s_ = -1e9;
  double last_objects_s_ = -1e9;
  int refused_commands_ = 0;
  SteadyClock::time_point pacing_start_;
  double pacing_start_s_ = 0.0;

  SteadyClock::time_point diagnosed_;
  double diagnosed_s_ = 0.0;
  Diagnostics diagnostics_;  ///< Last: its timer uses the members above.
};

}  // namespace casepush
