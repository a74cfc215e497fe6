#include "casepush/ros/map_source.h"

#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/markers.h"
#include "casepush/ros/names.h"
#include "casepush/world/map_file.h"

namespace casepush {
namespace {

/// @throws InputError unless the message is in the map frame.
void checkFrame(const std::string& topic, const std::string& frame_id) {
  if (frame_id != names::kMapFrame) {
    throw InputError(topic, "is in frame '" + frame_id + "', must be in map");
  }
}

}  // namespace

MapSource::MapSource(const MapParameters& parameters, const Furnishing& furnishing,
                     ros::NodeHandle handle, const tf2_ros::Buffer& buffer, OnMap on_map)
    : parameters_(parameters), on_map_(std::move(on_map)) {
  octomap_ = handle.advertise<Octomap>(names::kOctomap.name, names::kOctomap.queue_size, true);
  markers_ = handle.advertise<visualization_msgs::MarkerArray>(names::kMapMarkers.name,
                                                               names::kMapMarkers.queue_size, true);
  save_ = handle.advertiseService(names::kSaveMapService, &MapSource::onSave, this);
  if (parameters.live_map) {
    live_ = std::make_unique<LiveMapper>(parameters, furnishing, handle, buffer, [this](Map map) {
      try {
        set(std::move(map));
      } catch (const InputError& error) {
        ROS_ERROR_THROTTLE(5.0, "live map is not used: %s", error.what());
      }
    });
  }
  if (parameters.source == MapOrigin::kFile) {
    start(loadMap(parameters.file, {parameters.resolution_m, parameters.occupancy}));
  } else if (parameters.source == MapOrigin::kSurvey) {
    subscriber_ = handle.subscribe(names::kSurvey.name, names::kSurvey.queue_size,
                                   &MapSource::onSurvey, this);
  } else if (parameters.source == MapOrigin::kGrid) {
    subscriber_ =
        handle.subscribe(names::kGrid.name, names::kGrid.queue_size, &MapSource::onGrid, this);
  }
}

std::string MapSource::missing() const {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!refused_.empty()) {
      return "refused: " + refused_;
    }
  }
  switch (parameters_.source) {
    case MapOrigin::kSurvey:
      return "topic survey; or give parameter map_file or map_source";
    case MapOrigin::kGrid:
      return "topic map";
    default:
      return "topic points, with TF from its frame to map";
  }
}

void MapSource::refuse(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  refused_ = why;
  ROS_ERROR("map refused%s: %s", map_ == nullptr ? "" : ", the one before stays in use",
            why.c_str());
}

void MapSource::onSurvey(const sensor_msgs::PointCloud2& message) {
  try {
    checkFrame("survey", message.header.frame_id);
    Map map(parameters_.resolution());
    map.addSurvey(fromMessage(message));
    start(std::move(map));
  } catch (const InputError& error) {
    refuse(error.what());
  }
}

void MapSource::onGrid(const nav_msgs::OccupancyGrid& message) {
  try {
    checkFrame("topic map", message.header.frame_id);
    start(
        mapOf(fromMessage(message), parameters_.occupancy, parameters_.resolution(), "topic map"));
  } catch (const InputError& error) {
    refuse(error.what());
  }
}

void MapSource::start(Map map) {
  if (live_ != nullptr) {
    live_->restart(map.copy());
  }
  set(std::move(map));
}

void MapSource::set(Map map) {
  const auto shared = std::make_shared<const Map>(std::move(map));
  on_map_(shared);
  octomap_.publish(toMessage(*shared, ros::Time::now().toSec()));
  markers_.publish(mapMarkers(*shared));
  const std::lock_guard<std::mutex> lock(mutex_);
  map_ = shared;
  refused_.clear();
}

bool MapSource::onSave(SaveMap::Request& request, SaveMap::Response& response) {
  try {
    std::shared_ptr<const Map> map;
    if (live_ != nullptr) {
      map = std::make_shared<const Map>(live_->map());
    } else {
      const std::lock_guard<std::mutex> lock(mutex_);
      map = map_;
    }
    if (map == nullptr || map->empty()) {
      throw InputError("save_map", "there is no map yet (" + missing() + ")");
    }
    map->save(request.file);
    response.success = true;
  } catch (const InputError& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

void MapSource::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (live_ != nullptr) {
    live_->report(status);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!refused_.empty()) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR, "map refused: " + refused_);
  }
}

}  // namespace casepush
