#include "casepush/ros/sim_node.h"

#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr double kControlPeriodS = 0.02;
constexpr int kTruthEvery = 5;  // Ground truth at 10 Hz keeps bags small.
// A controller counts as present for this long after its last command (simulated time); longer if
// that was to move: nobody leaves a robot moving, so it is only late.
constexpr double kCommandedS = 0.25;
constexpr double kMovingS = 1.0;
// Tracked poses may lag this far behind without holding up the world, if they came after the last
// images. Perception counts as present
// for longer than the executor waits for it: otherwise that time would pass in a moment.
constexpr double kTrackingLagS = 0.07;
constexpr double kTrackedS = 3.0;
// At full speed: never slower than real time for slow nodes, and some rest for them while nobody
// commands.
constexpr double kMostWaitS = kControlPeriodS;
constexpr double kRestS = 0.001;
constexpr double kClockPeriodS = 0.1;  // Of wall time, while time stands still.

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

std::vector<geometry_msgs::TransformStamped> sensorTransforms(const RobotModel& robot) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const CameraModel& camera : robot.cameras) {
    transforms.push_back(stamped(names::kBaseFrame, opticalFrame(camera.name), 0.0,
                                 toTransformMessage(camera.base_T_camera)));
  }
  for (const RangeSensorModel& sensor : robot.range_sensors) {
    transforms.push_back(stamped(names::kBaseFrame, rangeFrame(sensor.name), 0.0,
                                 toTransformMessage(sensor.base_T_sensor)));
  }
  return transforms;
}

SimNode::SimNode(SimNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      simulator_(parameters_.world, parameters_.robot, parameters_.models, parameters_.simulator),
      handle_(handle),
      diagnostics_(handle, "simulation", [this](auto& status) { reportDiagnostics(status); }) {
  // In lock-step a call may take many periods at once, and none of their messages may be lost.
  const auto advertise = [this](const names::Topic& topic, auto example) {
    return handle_.advertise<decltype(example)>(topic.name,
                                                parameters_.lock_step ? 0 : topic.queue_size);
  };
  clock_ = advertise(names::kClock, rosgraph_msgs::Clock());
  odometry_ = advertise(names::kOdometry, nav_msgs::Odometry());
  tags_ = advertise(names::kTagDetections, AprilTagDetectionArray());
  true_objects_ = advertise(names::kTrueObjects, PushableObjectArray());
  contacts_ = advertise(names::kContacts, BodyContactArray());
  true_loads_ = handle_.advertise<ObjectLoadArray>(names::kTrueLoads.name,
                                                   names::kTrueLoads.queue_size, true);
  points_ = advertise(names::kPoints, sensor_msgs::PointCloud2());
  survey_ = handle_.advertise<sensor_msgs::PointCloud2>(names::kSurvey.name,
                                                        names::kSurvey.queue_size, true);
  command_ = handle_.subscribe(names::kCommandVelocity.name, names::kCommandVelocity.queue_size,
                               &SimNode::onCommand, this, ros::TransportHints().tcpNoDelay());
  objects_ = handle_.subscribe(names::kObjects.name, 1, &SimNode::onObjects, this,
                               ros::TransportHints().tcpNoDelay());
  reset_ = handle_.advertiseService(names::kResetService, &SimNode::onReset, this);
  set_poses_ = handle_.advertiseService(names::kSetPoseService, &SimNode::onSetPoses, this);
  set_load_ = handle_.advertiseService(names::kSetLoadService, &SimNode::onSetLoad, this);
  step_ = handle_.advertiseService(names::kStepService, &SimNode::onStep, this);
  static_transforms_.sendTransform(sensorTransforms(parameters_.robot));
  publishSurvey();
  publishLoads();
  restartPacing();
  diagnosed_ = SteadyClock::now();
}

void SimNode::run() {
  const double end_s = parameters_.max_sim_time_s;
  while (ros::ok() && (end_s <= 0.0 || simulator_.time() < end_s)) {
    if (parameters_.lock_step) {
      standStill();
    } else {
      advance(stepsToPeriodEnd());
      command_arrived_ = false;
      waitForNodes();
    }
  }
}

void SimNode::standStill() {
  // Whoever comes late needs to hear the time once, too.
  publishClock();
  ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kClockPeriodS));
}

std::int64_t SimNode::stepsToPeriodEnd() const {
  // The control period is no whole number of physics steps: the number of steps varies by one.
  const double end_s = static_cast<double>(period_ + 1) * kControlPeriodS;
  const double steps = std::ceil((end_s - simulator_.time()) / simulator_.stepSeconds() - 0.5);
  return std::max<std::int64_t>(0, static_cast<std::int64_t>(steps));
}

void SimNode::advance(std::int64_t steps) {
  simulator_.setScanning(points_.getNumSubscribers() > 0);  // Rays cost time.
  while (steps > 0 && ros::ok()) {
    const std::int64_t to_end = stepsToPeriodEnd();
    const std::int64_t now = std::min(steps, to_end);
    simulator_.step(static_cast<int>(now));
    steps -= now;
    if (now == to_end) {
      publishPeriod();
    }
  }
}

void SimNode::publishPeriod() {
  publishClock();
  publishMotion();
  publishSensors();
  publishTruth();
  ++period_;
}

void SimNode::publishClock() {
  rosgraph_msgs::Clock clock;
  clock.clock = toRosTime(simulator_.time());
  clock_.publish(clock);
}

void SimNode::publishMotion() {
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
    images_seen_ = false;
  }
  for (const RangeScan& scan : simulator_.takeScans()) {
    points_.publish(toMessage(scan));
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

void SimNode::publishLoads() {
  ObjectLoadArray message;
  message.header.stamp = toRosTime(simulator_.time());
  for (const ObjectPlacement& placement : simulator_.world().objects) {
    if (const std::optional<Load> load = simulator_.load(placement.id)) {
      message.loads.push_back(toMessage(placement.id, *load));
    }
  }
  true_loads_.publish(message);
}

void SimNode::publishSurvey() {
  const std::vector<Eigen::Vector3f> points =
      surveyPoints(parameters_.world, parameters_.survey_resolution_m);
  survey_.publish(toMessage(points, simulator_.time()));
}

bool SimNode::isCommanded() const {
  return simulator_.time() - last_command_s_ < (commanded_to_move_ ? kMovingS : kCommandedS);
}

bool SimNode::nodesKeepUp(SteadyClock::time_point rested) const {
  const double lag_s = simulator_.time() - last_objects_s_;
  const bool is_tracked = lag_s > kTrackedS || (images_seen_ && lag_s < kTrackingLagS);
  return is_tracked && (isCommanded() ? command_arrived_ : SteadyClock::now() >= rested);
}

void SimNode::waitForNodes() {
  const bool full_speed = parameters_.real_time_factor <= 0.0;
  const double elapsed_s = simulator_.time() - pacing_start_s_;
  const auto seconds = [](double s) {
    return std::chrono::duration_cast<SteadyClock::duration>(std::chrono::duration<double>(s));
  };
  const SteadyClock::time_point now = SteadyClock::now();
  const SteadyClock::time_point rested = now + seconds(kRestS);
  const SteadyClock::time_point deadline =
      full_speed ? now + seconds(kMostWaitS)
                 : pacing_start_ + seconds(elapsed_s / parameters_.real_time_factor);
  const double slice_s = full_speed ? kRestS : 0.1;  // Notices a shutdown at a low factor.
  ros::CallbackQueue& queue = *ros::getGlobalCallbackQueue();
  queue.callAvailable();
  while (ros::ok() && !(full_speed && nodesKeepUp(rested))) {
    const double left_s = std::chrono::duration<double>(deadline - SteadyClock::now()).count();
    if (left_s <= 0.0) {
      break;
    }
    queue.callAvailable(ros::WallDuration(std::min(left_s, slice_s)));
  }
}

void SimNode::restartPacing() {
  pacing_start_ = SteadyClock::now();
  pacing_start_s_ = simulator_.time();
}

void SimNode::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const SteadyClock::time_point now = SteadyClock::now();
  const double wall_s = std::chrono::duration<double>(now - diagnosed_).count();
  const double factor = (simulator_.time() - diagnosed_s_) / std::max(wall_s, 1e-9);
  diagnosed_ = now;
  diagnosed_s_ = simulator_.time();
  if (parameters_.lock_step) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "in lock-step");
  } else {
    status.summaryf(diagnostic_msgs::DiagnosticStatus::OK, "%.1f times real time", factor);
  }
  status.add("simulated time [s]", simulator_.time());
  status.add("commanded", isCommanded());
  status.add("commands ignored or clamped", refused_commands_);
}

}  // namespace casepush
