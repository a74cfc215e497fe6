#pragma once

#include <casepush/Octomap.h>
#include <casepush/SaveMap.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_ros/buffer.h>

#include <functional>
#include <memory>
#include <mutex>

#include "casepush/ros/live_mapper.h"
#include "casepush/ros/node_parameters.h"

namespace casepush {

/// Where the planner's map comes from: a file, a survey, a floor plan, and live scans on top.
///
/// Publishes the map and saves it on request (service save_map). Thread safety: all members.
class MapSource {
 public:
  /// Called with every new map, from whatever thread brought it. @throws InputError if it is of no
  /// use; it is then not published.
  using OnMap = std::function<void(std::shared_ptr<const Map>)>;

  /// @throws InputError if the map file cannot be read. @pre `buffer` outlives this.
  MapSource(const MapParameters& parameters, const Furnishing& furnishing, ros::NodeHandle handle,
            const tf2_ros::Buffer& buffer, OnMap on_map);

  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  /// What there is no map without, for a person.
  std::string missing() const;

 private:
  void onSurvey(const sensor_msgs::PointCloud2& message);
  void onGrid(const nav_msgs::OccupancyGrid& message);
  bool onSave(SaveMap::Request& request, SaveMap::Response& response);
  void refuse(const std::string& why);
  void start(Map map);
  void set(Map map);

  MapParameters parameters_;
  OnMap on_map_;
  mutable std::mutex mutex_;  ///< Guards map_ and refused_.
  std::shared_ptr<const Map> map_;
  std::string refused_;  ///< Why the latest map was; empty: it was not.
  ros::Publisher octomap_;
  ros::Publisher markers_;
  ros::Subscriber subscriber_;
  ros::ServiceServer save_;
  std::unique_ptr<LiveMapper> live_;  ///< Last: its thread uses the members above.
};

}  // namespace casepush
