#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "casepush/model/object_model.h"
#include "casepush/model/observation.h"
#include "casepush/model/range_scan.h"
#include "casepush/model/robot_model.h"
#include "casepush/world/map.h"
#include "casepush/world/shadow.h"

namespace casepush {

struct LiveMapOptions {
  double max_range_m = 8.0;      ///< Beams count up to there.
  double floor_m = 0.05;         ///< What is lower is the floor,
  double ceiling_m = 2.0;        ///< and what is higher than this is left out.
  double object_margin_m = 0.1;  ///< Points so near to a known object are taken for it.
  double robot_margin_m = 0.05;  ///< The same for the robot itself.
  double memory_s = 1.0;         ///< The same where an object was this long before the scan.
  void validate() const;         ///< @throws InputError listing every violation.
};

/// A map that follows the scans of a range sensor.
///
/// Every beam frees the cells along it and fills the one where it ends, unless that lies on a known
/// object or on the robot: these are masked out, so that furniture never becomes part of the map.
/// What an object left behind in the map before it was known to be there is removed as soon as it
/// is.
/// Cost of a scan: proportional to its beams' length in cells; see docs/worlds.md.
/// Thread safety: none.
class LiveMap {
 public:
  /// @param start  What is known beforehand; may be empty.
  LiveMap(Map start, const RobotModel& robot, const std::map<std::string, ObjectModel>& models,
          LiveMapOptions options);

  /// Tracked poses; those of unknown models are passed over. An object that is no longer among
  /// them is assumed to stand where it was last.
  /// @return  What an object at rest had left in the map where it stands, and is removed now.
  /// @pre finite poses.
  MapChange observe(const std::vector<ObjectState>& objects);

  struct Integration {
    int hits = 0;    ///< Beams that ended at something static.
    int masked = 0;  ///< Beams that ended at a known object or at the robot.
    MapChange change;
  };
  /// @param scan  Points in the sensor's frame [m]; not finite where there was no return.
  /// Neighbours
  ///   in a layer tell the slope of what they hit.
  /// @throws InputError if a pose is not finite or the sensor is too far away.
  Integration integrate(const RangeScan& scan, const Eigen::Isometry3d& map_T_sensor,
                        const Pose2& map_T_robot);

  const Map& map() const { return map_; }

 private:
  struct Place {
    Pose2 map_T_object;
    double stamp_s = 0.0;  ///< When the object was there last.
  };
  struct Track {
    std::string model;
    std::deque<Place> places;  ///< Oldest first; the last is the newest.
    Twist2 twist;
    bool moving = false;
    bool cleared = false;  ///< Nothing of the map is left where it stands.
  };
  struct Mask;
  struct Body {
    std::vector<ConvexPart> parts;
    double reach_m = 0.0;
  };

  std::vector<Mask> masksAt(double stamp_s, const Pose2& map_T_robot) const;
  SensorRay rayTo(const Eigen::Vector3f& map_origin, const Eigen::Vector3f& map_point,
                  const std::vector<Mask>& masks, Integration* result) const;
  enum class Clear { kResting, kAll };
  /// Where the map has not been cleared of them yet.
  MapChange clearObjects(Clear which);

  Map map_;
  LiveMapOptions options_;
  Body robot_;
  std::map<std::string, Body> models_;
  std::map<std::string, Track> tracks_;
};

}  // namespace casepush
