#include "casepush/ros/perception_node.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <functional>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/markers.h"
#include "casepush/ros/names.h"
#include "casepush/ros/sim_node.h"
#include "casepush/ros/transforms.h"

namespace casepush {
namespace {

constexpr double kSilentPeriodS = 0.04;  // Publish at least this often: poses move, ages grow.
constexpr double kMarkerPeriodS = 0.2;
constexpr double kFadedAfterS = 1.0;
constexpr std::uint32_t kFilterQueue = 100;

class Call : public ros::CallbackInterface {
 public:
  explicit Call(std::function<void()> work) : work_(std::move(work)) {}
  CallResult call() override {
    work_();
    return Success;
  }

 private:
  std::function<void()> work_;
};

}  // namespace

PerceptionNode::PerceptionNode(PerceptionNodeParameters parameters, ros::NodeHandle handle)
    : parameters_(std::move(parameters)),
      handle_(handle),
      tracker_(parameters_.furnishing.instances, parameters_.tracker),
      listener_(buffer_, handle, false, ros::TransportHints().tcpNoDelay()),
      filter_(buffer_, names::kMapFrame, kFilterQueue, handle),
      diagnostics_(handle, "perception", [this](auto& status) { reportDiagnostics(status); }) {
  objects_ =
      handle_.advertise<PushableObjectArray>(names::kObjects.name, names::kObjects.queue_size);
  object_markers_ = handle_.advertise<MarkerArray>(names::kObjectMarkers.name,
                                                   names::kObjectMarkers.queue_size, true);
  robot_markers_ = handle_.advertise<MarkerArray>(names::kRobotMarkers.name,
                                                  names::kRobotMarkers.queue_size, true);
  robot_markers_.publish(robotMarkers(parameters_.furnishing.robot.mechanism));
  if (parameters_.publish_camera_frames) {
    static_transforms_.sendTransform(sensorTransforms(parameters_.furnishing.robot));
  }
  filter_.registerCallback(boost::function<void(const AprilTagDetectionArray::ConstPtr&)>(
      [this](const AprilTagDetectionArray::ConstPtr& message) { onTags(*message); }));
  filter_.connectInput(tags_);
  tags_.subscribe(handle_, names::kTagDetections.name, names::kTagDetections.queue_size,
                  ros::TransportHints().tcpNoDelay());
  timer_ = handle_.createTimer(ros::Duration(kSilentPeriodS), [this](const ros::TimerEvent&) {
    const double now_s = now();
    if (now_s - last_published_s_ >= kSilentPeriodS) {
      publish(now_s);
    }
  });
}

PerceptionNode::~PerceptionNode() {
  handle_.getCallbackQueue()->removeByID(reinterpret_cast<std::uint64_t>(this));
}

double PerceptionNode::now() {
  constexpr double kJumpS = 0.5;
  const double now_s = ros::Time::now().toSec();
  if (now_s < last_now_s_ - kJumpS) {
    ROS_INFO("time jumped back from %.3f s to %.3f s: tracks are forgotten", last_now_s_, now_s);
    tracker_.clear();
    buffer_.clear();
    newest_image_s_ = -1e9;
    last_published_s_ = -1e9;
    last_markers_s_ = -1e9;
  }
  last_now_s_ = now_s;
  const std::string ahead = ahead_.check(buffer_);
  if (!ahead.empty()) {
    ROS_WARN_THROTTLE(1.0, "%s", ahead.c_str());
  }
  return now_s;
}

void PerceptionNode::onTags(const AprilTagDetectionArray& message) {
  const ros::Time stamp = message.header.stamp;
  images_.add(message.header.frame_id, stamp.toSec(), now());
  ++frames_;
  try {
    if (isAhead(stamp.toSec())) {
      throw InputError(message.header.frame_id, "is stamped ahead of the clock");
    }
    const Pose2 map_T_robot = planarPose(
        fromMessage(buffer_.lookupTransform(names::kMapFrame, names::kBaseFrame, stamp).transform));
    const Eigen::Isometry3d base_T_camera = fromMessage(
        buffer_.lookupTransform(names::kBaseFrame, message.header.frame_id, stamp).transform);
    std::string left_out;
    tracker_.addFrame(fromMessage(message, &left_out), map_T_robot, base_T_camera);
    if (!left_out.empty()) {
      ROS_WARN_THROTTLE(1.0, "tag_detections: left out: %s", left_out.c_str());
    }
  } catch (const tf2::TransformException& error) {
    ++bad_frames_;
    ROS_WARN_THROTTLE(1.0, "tag_detections: image left out: %s", error.what());
    return;
  } catch (const InputError& error) {
    ++bad_frames_;
    ROS_WARN_THROTTLE(1.0, "tag_detections: image left out: %s", error.what());
    return;
  }
  newest_image_s_ = stamp.toSec();
  publishSoon();
}

void PerceptionNode::publishSoon() {
  if (will_publish_) {
    return;
  }
  will_publish_ = true;
  handle_.getCallbackQueue()->addCallback(boost::make_shared<Call>([this] {
                                            will_publish_ = false;
                                            publish(std::max(newest_image_s_, now()));
                                          }),
                                          reinterpret_cast<std::uint64_t>(this));
}

void PerceptionNode::publish(double now_s) {
  last_published_s_ = now_s;
  const std::vector<ObjectState> states = tracker_.states(now_s);
  objects_.publish(toMessage(states, now_s));
  if (now_s - last_markers_s_ >= kMarkerPeriodS) {
    last_markers_s_ = now_s;
    publishMarkers(states, now_s);
  }
}

void PerceptionNode::publishMarkers(const std::vector<ObjectState>& states, double now_s) {
  std::vector<ShownObject> shown;
  for (const ObjectState& state : states) {
    const auto model = parameters_.furnishing.models.find(state.model);
    if (model != parameters_.furnishing.models.end()) {
      shown.push_back({state, &model->second.mechanism});
    }
  }
  object_markers_.publish(objectMarkers(shown, now_s, kFadedAfterS));
}

void PerceptionNode::reportDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const bool blind = frames_ == 0;
  status.summary(
      blind ? diagnostic_msgs::DiagnosticStatus::WARN : diagnostic_msgs::DiagnosticStatus::OK,
      blind ? "no images with a known camera pose came" : "tracking");
  const std::string complaint = images_.complaint();
  if (!complaint.empty()) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, complaint);
  }
  status.add("images since the last report", frames_);
  status.add("images left out in all", bad_frames_);
  status.add("detections ignored in all", tracker_.ignoredDetections());
  frames_ = 0;
}

}  // namespace casepush
