#include "casepush/ros/sim_node.h"

#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr double kControlPeriodS = 0.02;
constexpr int kTruthEvery = 5;  // Ground truth at 10 Hz keeps bags small.
// A controller counts as present for this long after its last command (simulated time).
constexpr double kCommandedS = 0.25;
// The same for the newest tracked poses, which may lag this far behind without holding up the
// world.
constexpr double kTrackedS = 0.5;
constexpr double kTrackingLagS = 0.07;
// At full speed: never slower than real time for a slow controller, and some rest for the other
// nodes while nobody commands.
constexpr double kWaitCommandedS = kControlPeriodS;
constexpr double kWaitIdleS = 0.001;

geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child,
                                        double stamp_s, const geometry_msgs::Transform& transform) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.header.stamp = toRosTime(stamp_s);
  message.child_frame_id = child;
  message.transform = transform;
  return message;
}

}  // namespace

std::vector<geometry_msgs::TransformStamped> cameraTransforms(const RobotModel& robot) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const CameraModel& camera : robot.cameras) {
    transforms.push_back(stamped(names::kBaseFrame, opticalFrame(camera.name), 0.0,
                                 toTransformMessage(camera.base_T_camera)));
  }
  return transforms;
}

SimNode::SimNode(SimNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      simulator_(parameters_.world, parameters_.robot, parameters_.models, parameters_.simulator),
      handle_(handle),
      diagnostics_(handle, "simulation", [this](auto& status) { reportDiagnostics(status); }) {
  clock_ = handle_.advertise<rosgraph_msgs::Clock>(names::kClock.name, names::kClock.queue_size);
  odometry_ =
      handle_.advertise<nav_msgs::Odometry>(names::kOdometry.name, names::kOdometry.queue_size);
  tags_ = handle_.advertise<AprilTagDetectionArray>(names::kTagDetections.name,
                                                    names::kTagDetections.queue_size);
  true_objects_ = handle_.advertise<PushableObjectArray>(names::kTrueObjects.name,
                                                         names::kTrueObjects.queue_size);
  contacts_ =
      handle_.advertise<BodyContactArray>(names::kContacts.name, names::kContacts.queue_size);
  points_ = handle_.advertise<sensor_msgs::PointCloud2>(names::kPoints.name,
                                                        names::kPoints.queue_size, true);
  command_ = handle_.subscribe(names::kCommandVelocity.name, names::kCommandVelocity.queue_size,
                               &SimNode::onCommand, this, ros::TransportHints().tcpNoDelay());
  objects_ = handle_.subscribe(names::kObjects.name, 1, &SimNode::onObjects, this,
                               ros::TransportHints().tcpNoDelay());
  reset_ = handle_.advertiseService(names::kResetService, &SimNode::onReset, this);
  set_poses_ = handle_.advertiseService(names::kSetPoseService, &SimNode::onSetPoses, this);
  static_transforms_.sendTransform(cameraTransforms(parameters_.robot));
  publishSurvey();
  restartPacing();
  diagnosed_ = SteadyClock::now();
}

void SimNode::run() {
  const double end_s = parameters_.max_sim_time_s;
  while (ros::ok() && (end_s <= 0.0 || simulator_.time() < end_s)) {
    advance();
    command_arrived_ = false;
    publishMotion();
    publishSensors();
    publishTruth();
    ++period_;
    waitForNodes();
  }
}

void SimNode::advance() {
  // The control period is no whole number of physics steps: the number of steps varies by one.
  next_period_s_ += kControlPeriodS;
  while (simulator_.time() + 0.5 * simulator_.stepSeconds() < next_period_s_) {
    simulator_.step();
  }
}

void SimNode::publishMotion() {
  rosgraph_msgs::Clock clock;
  clock.clock = toRosTime(simulator_.time());
  clock_.publish(clock);
  const OdometryReading reading = simulator_.odometry();
  transforms_.sendTransform({stamped(names::kMapFrame, names::kOdomFrame, reading.stamp_s,
                                     toTransformMessage(reading.map_T_odom)),
                             stamped(names::kOdomFrame, names::kBaseFrame, reading.stamp_s,
                                     toTransformMessage(reading.odom_T_robot))});
  odometry_.publish(toMessage(reading));
}

void SimNode::publishSensors() {
  for (const TagFrame& frame : simulator_.takeTagFrames()) {
    tags_.publish(toMessage(frame));
  }
}

void SimNode::publishTruth() {
  const std::vector<ContactReport> contacts = simulator_.takeContacts();
  if (!contacts.empty()) {
    contacts_.publish(toMessage(contacts, simulator_.time()));
  }
  if (period_ % kTruthEvery != 0) {
    return;
  }
  std::vector<ObjectState> states;
  for (const ObjectPlacement& placement : simulator_.world().objects) {
    ObjectState state;
    state.id = placement.id;
    state.model = simulator_.object(placement.id).name;
    state.map_T_object = simulator_.trueObjectPose(placement.id);
    state.twist = simulator_.trueObjectTwist(placement.id);
    state.stamp_s = simulator_.time();
    state.moving = state.twist.speed() > 0.0;
    states.push_back(state);
  }
  true_objects_.publish(toMessage(states, simulator_.time()));
}

void SimNode::publishSurvey() {
  const std::vector<Eigen::Vector3f> points =
      surveyPoints(parameters_.world, parameters_.survey_resolution_m);
  points_.publish(toMessage(points, simulator_.time()));
}

bool SimNode::isCommanded() const { return simulator_.time() - last_command_s_ < kCommandedS; }

bool SimNode::nodesKeepUp() const {
  const double lag_s = simulator_.time() - last_objects_s_;
  return command_arrived_ && (lag_s < kTrackingLagS || lag_s > kTrackedS);
}

void SimNode::waitForNodes() {
  const bool full_speed = parameters_.real_time_factor <= 0.0;
  const double wait_s = isCommanded() ? kWaitCommandedS : kWaitIdleS;
  const double elapsed_s = simulator_.time() - pacing_start_s_;
  const auto seconds = [](double s) {
    return std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(s));
  };
  const SteadyClock::time_point deadline =
      full_speed ? SteadyClock::now() + seconds(wait_s)
                 : pacing_start_ + seconds(elapsed_s / parameters_.real_time_factor);
  ros::CallbackQueue& queue = *ros::getGlobalCallbackQueue();
  queue.callAvailable();
  while (ros::ok() && !(full_speed && nodesKeepUp())) {
    const double left_s = std::chrono::duration<double>(deadline - SteadyClock::now()).count();
    if (left_s <= 0.0) {
      break;
    }
    // Short enough to notice a shutdown at a low real-time factor.
    queue.callAvailable(ros::WallDuration(std::min(left_s, 0.1)));
  }
}

void SimNode::restartPacing() {
  pacing_start_ = SteadyClock::now();
  pacing_start_s_ = simulator_.time();
}

void SimNode::onCommand(const geometry_msgs::Twist& message) {
  const Twist2 twist{message.linear.x, message.linear.y, message.angular.z};
  if (!simulator_.setCommand(twist)) {
    ++refused_commands_;
    ROS_WARN_THROTTLE(1.0, "cmd_vel (%g, %g, %g) is not finite or beyond the robot's limits",
                      twist.vx_mps, twist.vy_mps, twist.wz_rps);
  }
  command_arrived_ = true;
  last_command_s_ = simulator_.time();
}

void SimNode::onObjects(const PushableObjectArray& message) {
  last_objects_s_ = message.header.stamp.toSec();
}

bool SimNode::onReset(Reset::Request& request, Reset::Response& response) {
  simulator_.reset(request.seed);
  next_period_s_ = 0.0;
  period_ = 0;
  last_command_s_ = -1e9;
  last_objects_s_ = -1e9;
  restartPacing();
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

void SimNode::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const SteadyClock::time_point now = SteadyClock::now();
  const double wall_s = std::chrono::duration<double>(now - diagnosed_).count();
  const double factor = (simulator_.time() - diagnosed_s_) / std::max(wall_s, 1e-9);
  diagnosed_ = now;
  diagnosed_s_ = simulator_.time();
  status.summaryf(diagnostic_msgs::DiagnosticStatus::OK, "%.1f times real time", factor);
  status.add("simulated time [s]", simulator_.time());
  status.add("commanded", isCommanded());
  status.add("refused commands", refused_commands_);
}

}  // namespace casepush
