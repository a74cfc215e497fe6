#pragma once

#include <casepush/AprilTagDetectionArray.h>
#include <message_filters/subscriber.h>
#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <memory>

#include "casepush/perception/pose_tracker.h"
#include "casepush/ros/diagnostics.h"
#include "casepush/ros/image_tally.h"
#include "casepush/ros/node_parameters.h"
#include "casepush/ros/transforms.h"

namespace casepush {

/// Turns tag detections into tracked poses: looks up where the camera was, updates the tracker and
/// publishes `objects` as soon as the images that have come are worked off, and at 25 Hz if none
/// come.
class PerceptionNode {
 public:
  /// @throws InputError from the tracker.
  PerceptionNode(PerceptionNodeParameters parameters, ros::NodeHandle handle);
  ~PerceptionNode();

 private:
  using TagFilter = tf2_ros::MessageFilter<AprilTagDetectionArray>;

  void onTags(const AprilTagDetectionArray& message);
  /// The ROS clock's time; forgets all tracks if it has jumped back.
  double now();
  /// Once all callbacks have run that are due now: several cameras' images come together.
  void publishSoon();
  void publish(double now_s);
  void publishMarkers(const std::vector<ObjectState>& states, double now_s);
  void reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  PerceptionNodeParameters parameters_;
  ros::NodeHandle handle_;
  PoseTracker tracker_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  AheadWatch ahead_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  ros::Publisher objects_;
  ros::Publisher object_markers_;
  ros::Publisher robot_markers_;
  message_filters::Subscriber<AprilTagDetectionArray> tags_;
  TagFilter filter_;
  ros::Timer timer_;
  double last_now_s_ = -1e9;
  double newest_image_s_ = -1e9;  ///< Stamp of the last image.
  double last_published_s_ = -1e9;
  double last_markers_s_ = -1e9;
  bool will_publish_ = false;
  ImageTally images_;
  int frames_ = 0;
  int bad_frames_ = 0;
  Diagnostics diagnostics_;  ///< Last: its timer uses the members above.
};

}  // namespace casepush
