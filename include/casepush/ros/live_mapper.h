#pragma once

#include <casepush/PushableObjectArray.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>

#include "casepush/ros/node_parameters.h"
#include "casepush/world/live_map.h"

namespace casepush {

/// Keeps a LiveMap up to date with the topics `points` and `objects`, in a thread of its own.
///
/// Its work is bounded: at most `rate_hz` scans a second and half of one processor; scans in
/// between are passed over, and scans that come too late or without a pose are dropped and counted.
/// Thread safety: all members.
class LiveMapper {
 public:
  using OnChange = std::function<void(Map)>;

  /// @param on_change  Called from the mapper's thread with a copy when the map has changed, at
  ///   most every `publish_period_s`; at once if it held what turns out to be an object, which
  ///   nobody could plan with. @pre `buffer` outlives this.
  LiveMapper(const MapParameters& parameters, const Furnishing& furnishing, ros::NodeHandle handle,
             const tf2_ros::Buffer& buffer, OnChange on_change);
  ~LiveMapper();

  /// Forgets all scans and goes on from another map.
  void restart(Map start);

  Map map() const;

  /// Adds its counts and times; a warning if most scans are dropped.
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  using Clock = std::chrono::steady_clock;
  struct Counts {
    int used = 0;
    int passed_over = 0;
    int late = 0;
    int without_pose = 0;
    int bad = 0;
  };

  void onScan(const sensor_msgs::PointCloud2ConstPtr& message);
  void onObjects(const PushableObjectArray& message);
  void integrate(const sensor_msgs::PointCloud2& message);
  void publishIfDue();

  MapParameters parameters_;
  Furnishing furnishing_;
  const tf2_ros::Buffer& buffer_;
  OnChange on_change_;

  mutable std::mutex mutex_;  ///< Guards the members down to the next blank line.
  LiveMap map_;
  Counts counts_;
  Counts reported_;
  double last_scan_s_ = 0.0;  ///< Time that the last scan took.
  double longest_scan_s_ = 0.0;
  int changed_cells_ = 0;   ///< Since the last call of on_change_.
  bool is_urgent_ = false;  ///< The map held what is known to be an object.

  Clock::time_point next_scan_{};
  Clock::time_point last_change_{};
  ros::CallbackQueue queue_;
  ros::Subscriber points_;
  ros::Subscriber objects_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;  ///< Last: stops before the others go.
};

}  // namespace casepush
