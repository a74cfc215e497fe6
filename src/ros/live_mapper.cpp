#include "casepush/ros/live_mapper.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr double kPosePatience_s = 0.05;  // Of wall time, for the transform at a scan's stamp.
constexpr double kMostShare = 0.5;        // Of a processor.
// Fewer changed cells than these are mostly noise; they wait for more, or for so many periods.
constexpr int kFewCells = 25;
constexpr int kPatientPeriods = 5;

double secondsBetween(std::chrono::steady_clock::time_point from,
                      std::chrono::steady_clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

LiveMapper::LiveMapper(const MapParameters& parameters, const Furnishing& furnishing,
                       ros::NodeHandle handle, const tf2_ros::Buffer& buffer, OnChange on_change)
    : parameters_(parameters),
      furnishing_(furnishing),
      buffer_(buffer),
      on_change_(std::move(on_change)),
      map_(Map(parameters.resolution()), furnishing.robot, furnishing.models, parameters.live) {
  handle.setCallbackQueue(&queue_);
  points_ = handle.subscribe(names::kPoints.name, 1, &LiveMapper::onScan, this,
                             ros::TransportHints().tcpNoDelay());
  objects_ = handle.subscribe(names::kObjects.name, names::kObjects.queue_size,
                              &LiveMapper::onObjects, this, ros::TransportHints().tcpNoDelay());
  spinner_ = std::make_unique<ros::AsyncSpinner>(1, &queue_);
  spinner_->start();
}

LiveMapper::~LiveMapper() { spinner_->stop(); }

void LiveMapper::restart(Map start) {
  LiveMap fresh(std::move(start), furnishing_.robot, furnishing_.models, parameters_.live);
  const std::lock_guard<std::mutex> lock(mutex_);
  map_ = std::move(fresh);
  changed_cells_ = 0;
  is_urgent_ = false;
}

Map LiveMapper::map() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return map_.map().copy();
}

void LiveMapper::onObjects(const PushableObjectArray& message) {
  try {
    const std::vector<ObjectState> objects = fromMessage(message);
    const std::lock_guard<std::mutex> lock(mutex_);
    const int cleared = map_.observe(objects).cells;
    changed_cells_ += cleared;
    is_urgent_ = is_urgent_ || cleared > 0;
  } catch (const InputError& error) {
    ROS_ERROR_THROTTLE(1.0, "objects ignored: %s", error.what());
  }
  publishIfDue();
}

void LiveMapper::onScan(const sensor_msgs::PointCloud2ConstPtr& message) {
  const Clock::time_point start = Clock::now();
  if (start < next_scan_) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.passed_over;
    return;
  }
  try {
    integrate(*message);
  } catch (const InputError& error) {
    ROS_ERROR_THROTTLE(1.0, "scan ignored: %s", error.what());
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.bad;
  } catch (const tf2::TransformException& error) {
    ROS_WARN_THROTTLE(5.0, "scan ignored: %s", error.what());
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.without_pose;
  }
  publishIfDue();
  const double spent_s = secondsBetween(start, Clock::now());
  const double pause_s = std::max(1.0 / parameters_.live_rate_hz, spent_s / kMostShare);
  next_scan_ =
      start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(pause_s));
}

void LiveMapper::integrate(const sensor_msgs::PointCloud2& message) {
  const ros::Time stamp = message.header.stamp;
  if ((ros::Time::now() - stamp).toSec() > parameters_.live_max_delay_s) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++counts_.late;
    return;
  }
  const auto pose = [&](const std::string& frame) {
    // In wall time: the clock of a simulator may stand still.
    const Clock::time_point end =
        Clock::now() +
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kPosePatience_s));
    while (!buffer_.canTransform(names::kMapFrame, frame, stamp) && Clock::now() < end) {
      ros::WallDuration(0.002).sleep();
    }
    return fromMessage(buffer_.lookupTransform(names::kMapFrame, frame, stamp).transform);
  };
  const RangeScan scan = scanFromMessage(message);
  const Eigen::Isometry3d map_T_sensor = pose(message.header.frame_id);
  const Pose2 map_T_robot = planarPose(pose(names::kBaseFrame));
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point start = Clock::now();
  changed_cells_ += map_.integrate(scan, map_T_sensor, map_T_robot).change.cells;
  last_scan_s_ = secondsBetween(start, Clock::now());
  longest_scan_s_ = std::max(longest_scan_s_, last_scan_s_);
  ++counts_.used;
}

void LiveMapper::publishIfDue() {
  const Clock::time_point now = Clock::now();
  const double waited_s = secondsBetween(last_change_, now);
  std::optional<Map> copy;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const int periods = changed_cells_ >= kFewCells ? 1 : kPatientPeriods;
    const bool is_due = is_urgent_ || waited_s >= periods * parameters_.live_publish_period_s;
    if (changed_cells_ == 0 || !is_due) return;
    copy = map_.map().copy();
    changed_cells_ = 0;
    is_urgent_ = false;
  }
  last_change_ = now;
  on_change_(std::move(*copy));
}

void LiveMapper::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const int used = counts_.used - reported_.used;
  const int dropped = counts_.late + counts_.without_pose + counts_.bad - reported_.late -
                      reported_.without_pose - reported_.bad;
  reported_ = counts_;
  if (dropped > used) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                        "most scans are dropped: late, or without a pose");
  }
  status.add("scans in the map", counts_.used);
  status.add("scans passed over to save time", counts_.passed_over);
  status.add("scans dropped: too late", counts_.late);
  status.add("scans dropped: no pose", counts_.without_pose);
  status.add("scans dropped: bad", counts_.bad);
  status.add("last scan took [s]", last_scan_s_);
  status.add("longest scan took [s]", longest_scan_s_);
}

}  // namespace casepush
