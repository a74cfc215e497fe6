#pragma once

#include <casepush/StartDemonstration.h>
#include <casepush/StopDemonstration.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>

#include <functional>
#include <memory>
#include <string>

#include "casepush/execution/demonstration.h"
#include "casepush/ros/node_parameters.h"
#include "casepush/ros/object_watch.h"

namespace casepush {

/// The services demonstration/start and demonstration/stop: records at each odometry message what
/// robot and object do. To be used by one thread.
class DemonstrationServer {
 public:
  struct Callbacks {
    std::function<std::string()> why_not_now;        ///< "" if a demonstration may begin.
    std::function<std::int64_t(const Case&)> store;  ///< Returns the new case's id.
  };
  /// @param furnishing, objects  Must outlive this.
  DemonstrationServer(const Furnishing& furnishing, const ObjectWatch& objects,
                      DemonstrationOptions options, ros::NodeHandle handle, Callbacks callbacks);

  bool isRecording() const { return recording_ != nullptr; }

 private:
  /// Lives as long as a demonstration lasts.
  struct Recording {
    Recording(std::string id, const TrackedObject& instance, const RobotModel& robot,
              const DemonstrationOptions& options, ros::NodeHandle handle);
    std::string object_id;
    Demonstration demonstration;
    tf2_ros::Buffer buffer;
    tf2_ros::TransformListener listener;
    ros::Subscriber odometry;
  };

  bool onStart(StartDemonstration::Request& request, StartDemonstration::Response& response);
  bool onStop(StopDemonstration::Request& request, StopDemonstration::Response& response);
  void onOdometry(const nav_msgs::Odometry& message);

  const Furnishing& furnishing_;
  const ObjectWatch& objects_;
  DemonstrationOptions options_;
  ros::NodeHandle handle_;
  Callbacks callbacks_;
  std::unique_ptr<Recording> recording_;
  ros::ServiceServer start_;
  ros::ServiceServer stop_;
};

}  // namespace casepush
