#include "casepush/ros/demonstration_server.h"

#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"
#include "casepush/ros/transforms.h"

namespace casepush {

DemonstrationServer::Recording::Recording(std::string id, const TrackedObject& instance,
                                          const RobotModel& robot,
                                          const DemonstrationOptions& options,
                                          ros::NodeHandle handle)
    : object_id(std::move(id)),
      demonstration(object_id, instance.model, robot, options),
      listener(buffer, handle, false, ros::TransportHints().tcpNoDelay()) {}

DemonstrationServer::DemonstrationServer(const Furnishing& furnishing, const ObjectWatch& objects,
                                         DemonstrationOptions options, ros::NodeHandle handle,
                                         Callbacks callbacks)
    : furnishing_(furnishing),
      objects_(objects),
      options_(options),
      handle_(handle),
      callbacks_(std::move(callbacks)),
      start_(handle_.advertiseService(names::kStartDemonstrationService,
                                      &DemonstrationServer::onStart, this)),
      stop_(handle_.advertiseService(names::kStopDemonstrationService, &DemonstrationServer::onStop,
                                     this)) {}

bool DemonstrationServer::onStart(StartDemonstration::Request& request,
                                  StartDemonstration::Response& response) {
  const TrackedObject* instance = furnishing_.instance(request.object_id);
  if (instance == nullptr) {
    response.message = "unknown object '" + request.object_id + "'";
    return true;
  }
  response.message = callbacks_.why_not_now();
  if (!response.message.empty()) {
    return true;
  }
  if (!objects_.find(request.object_id)) {
    response.message = request.object_id + " has not been seen (topic objects)";
    return true;
  }
  recording_ = std::make_unique<Recording>(request.object_id, *instance, furnishing_.robot,
                                           options_, handle_);
  recording_->odometry =
      handle_.subscribe(names::kOdometry.name, names::kOdometry.queue_size,
                        &DemonstrationServer::onOdometry, this, ros::TransportHints().tcpNoDelay());
  response.success = true;
  response.message = "recording " + request.object_id + "; push it once and call stop";
  return true;
}

void DemonstrationServer::onOdometry(const nav_msgs::Odometry& message) {
  if (recording_ == nullptr) {
    return;
  }
  const std::optional<ObjectState> object = objects_.find(recording_->object_id);
  try {
    const StampedRobotPose robot = robotPose(recording_->buffer);
    Observation observation;
    observation.stamp_s = message.header.stamp.toSec();
    observation.map_T_robot = robot.map_T_robot;
    observation.robot_stamp_s = robot.stamp_s;
    observation.robot_twist = fromMessage(message.twist.twist);
    if (object) {
      observation.objects.push_back(*object);
    }
    recording_->demonstration.add(observation);
  } catch (const std::exception& error) {
    // TF takes a moment to arrive; later on, gaps show in the recording.
    ROS_DEBUG_THROTTLE(1.0, "not recorded: %s", error.what());
  }
}

bool DemonstrationServer::onStop(StopDemonstration::Request& request,
                                 StopDemonstration::Response& response) {
  if (recording_ == nullptr) {
    response.message = "no demonstration is under way (service demonstration/start)";
    return true;
  }
  if (request.discard) {
    recording_.reset();
    response.success = true;
    response.message = "discarded";
    return true;
  }
  const Demonstration::Result result = recording_->demonstration.result();
  response.message = result.explanation;
  if (result.wait) {
    return true;
  }
  recording_.reset();
  if (result.recorded) {
    try {
      response.case_id = callbacks_.store(*result.recorded);
      response.success = true;
    } catch (const InputError& error) {
      response.message = error.what();
    }
  }
  ROS_INFO("demonstration: %s", response.message.c_str());
  return true;
}

}  // namespace casepush
