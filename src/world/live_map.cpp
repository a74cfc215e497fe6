#include "casepush/world/live_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/violations.h"

namespace casepush {
namespace {

constexpr double kSamePlace_m = 0.02;
constexpr double kSamePlace_rad = 0.03;
constexpr double kMostPrediction_s = 0.5;
/// Points of a layer that are farther apart are not on one surface.
constexpr float kSameSurface_m = 0.3F;
constexpr float kMostBlur_m = 0.5F;

bool isSamePlace(const Pose2& a, const Pose2& b) {
  return distance(a, b) < kSamePlace_m && std::abs(yawDifference(a, b)) < kSamePlace_rad;
}

double reachOf(const std::vector<ConvexPart>& parts) {
  double reach_m = 0.0;
  for (const ConvexPart& part : parts) reach_m = std::max(reach_m, part.reach());
  return reach_m;
}

bool covers(const std::vector<ConvexPart>& parts, const Eigen::Vector2d& point, double z_m,
            double margin_m) {
  return std::any_of(parts.begin(), parts.end(), [&](const ConvexPart& part) {
    return z_m > part.heights().low_m - margin_m && z_m < part.heights().high_m + margin_m &&
           separation(part.shadow(), point) < margin_m;
  });
}

bool overlaps(const std::vector<ConvexPart>& parts, const Pose2& body_T_map,
              const Eigen::AlignedBox3d& cell) {
  const Shadow square =
      transformed(body_T_map, rectangle(cell.min().head<2>(), cell.max().head<2>()));
  return std::any_of(parts.begin(), parts.end(), [&](const ConvexPart& part) {
    return part.touches(cell.min().z(), cell.max().z()) && closerThan(part.shadow(), square, 0.0);
  });
}

/// Cuts the ray where it leaves the heights that count; false if it starts outside of them.
bool cutAtHeights(double low_m, double high_m, const Eigen::Vector3f& origin, SensorRay* ray) {
  if (origin.z() <= low_m || origin.z() >= high_m) return false;
  const double bound_m = std::clamp<double>(ray->map_end.z(), low_m, high_m);
  if (bound_m == static_cast<double>(ray->map_end.z())) return true;
  const auto share = static_cast<float>((bound_m - origin.z()) / (ray->map_end.z() - origin.z()));
  *ray = {origin + share * (ray->map_end - origin), false};
  return true;
}

/// How much of a ray before its end may lie in cells that its surface passes through: in a cell of
/// `size_m` the surface's place is unknown, and flat incidence draws that out along the ray.
float blurOf(const RangeScan& scan, std::size_t index, float size_m) {
  const Eigen::Vector3f& point = scan.points[index];
  const std::size_t beams = std::max(1, scan.beams);
  const std::size_t first = index - index % beams;
  const std::size_t last = std::min(first + beams, scan.points.size()) - 1;
  Eigen::Vector3f ends[] = {point, point};
  const std::size_t neighbours[] = {index > first ? index - 1 : index,
                                    index < last ? index + 1 : index};
  for (int side = 0; side < 2; ++side) {
    const Eigen::Vector3f& other = scan.points[neighbours[side]];
    if (other.allFinite() && (other - point).norm() < kSameSurface_m) ends[side] = other;
  }
  const Eigen::Vector3f along = ends[1] - ends[0];
  if (!(along.norm() > 0.0F)) return 2.0F * size_m;
  const float sine = along.normalized().cross(point.normalized()).norm();
  return std::min(size_m * (1.0F + 1.0F / std::max(sine, 0.01F)), kMostBlur_m);
}

}  // namespace

/// A body somewhere whose points are not static.
struct LiveMap::Mask {
  const Body* body;
  Pose2 body_T_map;
  double margin_m;

  /// @param most_m  Bounds the margin.
  bool covers(const Eigen::Vector3f& map_point, double most_m) const {
    const Eigen::Vector2d point = body_T_map * Eigen::Vector2d(map_point.head<2>().cast<double>());
    const double used_m = std::min(margin_m, most_m);
    const double reach_m = body->reach_m + used_m;
    return point.squaredNorm() < reach_m * reach_m &&
           casepush::covers(body->parts, point, map_point.z(), used_m);
  }
};

void LiveMapOptions::validate() const {
  Violations violations;
  violations.requirePositive("max_range_m", max_range_m, 100.0);
  violations.require("floor_m", floor_m, 0.0, 1.0);
  violations.require("ceiling_m", ceiling_m, floor_m, 100.0);
  violations.require("object_margin_m", object_margin_m, 0.0, 1.0);
  violations.require("robot_margin_m", robot_margin_m, 0.0, 1.0);
  violations.require("memory_s", memory_s, 0.0, 60.0);
  violations.throwIfAny("live map options");
}

LiveMap::LiveMap(Map start, const RobotModel& robot,
                 const std::map<std::string, ObjectModel>& models, LiveMapOptions options)
    : map_(std::move(start)), options_(options) {
  options_.validate();
  robot_.parts = convexParts(robot.solid);
  robot_.reach_m = reachOf(robot_.parts);
  for (const auto& [name, model] : models) {
    Body& body = models_[name];
    body.parts = convexParts(model.solid);
    body.reach_m = reachOf(body.parts);
  }
}

MapChange LiveMap::observe(const std::vector<ObjectState>& objects) {
  for (const ObjectState& object : objects) {
    if (models_.count(object.model) == 0) continue;
    Track& track = tracks_[object.id];
    track.model = object.model;
    // Time that runs backwards, as when a simulation starts anew, makes what was remembered void.
    if (!track.places.empty() && object.stamp_s < track.places.back().stamp_s - kMostPrediction_s) {
      track.places.clear();
    }
    track.moving = object.moving;
    track.twist = object.moving ? object.twist : Twist2();
    if (track.places.empty() ||
        !isSamePlace(track.places.back().map_T_object, object.map_T_object)) {
      track.places.push_back({object.map_T_object, object.stamp_s});
      track.cleared = false;
    }
    track.places.back().stamp_s = object.stamp_s;
    // Scans come late: what they may still ask for is kept.
    const double oldest_s = object.stamp_s - options_.memory_s - kMostPrediction_s;
    while (track.places.size() > 1 && track.places.front().stamp_s < oldest_s) {
      track.places.pop_front();
    }
  }
  return clearObjects(Clear::kResting);
}

std::vector<LiveMap::Mask> LiveMap::masksAt(double stamp_s, const Pose2& map_T_robot) const {
  std::vector<Mask> masks = {{&robot_, map_T_robot.inverse(), options_.robot_margin_m}};
  for (const auto& [id, track] : tracks_) {
    const Body& body = models_.at(track.model);
    const auto add = [&, margin_m = options_.object_margin_m](const Pose2& map_T_object) {
      masks.push_back({&body, map_T_object.inverse(), margin_m});
    };
    const Place& newest = track.places.back();
    for (const Place& place : track.places) {
      if (place.stamp_s >= stamp_s - options_.memory_s || &place == &newest) {
        add(place.map_T_object);
      }
    }
    const double ahead_s = std::clamp(stamp_s - newest.stamp_s, 0.0, kMostPrediction_s);
    const Twist2& twist = track.twist;
    if (ahead_s > 0.0 && (twist.speed() > 0.0 || twist.wz_rps != 0.0)) {
      add(newest.map_T_object *
          expSe2(ahead_s * Eigen::Vector3d(twist.vx_mps, twist.vy_mps, twist.wz_rps)));
    }
  }
  return masks;
}

SensorRay LiveMap::rayTo(const Eigen::Vector3f& map_origin, const Eigen::Vector3f& map_point,
                         const std::vector<Mask>& masks, Integration* result) const {
  const Eigen::Vector3f offset = map_point - map_origin;
  const auto range_m = static_cast<float>(options_.max_range_m);
  if (offset.norm() > range_m) return {map_origin + range_m * offset.normalized(), false};
  SensorRay ray{map_point, map_point.z() > options_.floor_m && map_point.z() < options_.ceiling_m};
  const auto covered = [&](double most_m) {
    return std::any_of(masks.begin(), masks.end(),
                       [&](const Mask& mask) { return mask.covers(map_point, most_m); });
  };
  const bool masked = covered(std::numeric_limits<double>::infinity());
  if (masked) {
    ray.hit = false;
    const auto cell_m = static_cast<float>(map_.resolution());
    // What ends on the body itself frees its cell, too: that may hold what was seen of the body
    // before it was known. Farther off a wall may stand in the cell.
    if (covered(map_.resolution())) {
      ray.map_end += cell_m * offset.normalized();
    } else {
      ray.blur_m = cell_m;
    }
  }
  result->masked += masked ? 1 : 0;
  result->hits += ray.hit ? 1 : 0;
  return ray;
}

MapChange LiveMap::clearObjects(Clear which) {
  MapChange change;
  for (auto& [id, track] : tracks_) {
    if (track.cleared || (track.moving && which == Clear::kResting)) continue;
    track.cleared = true;
    const Body& body = models_.at(track.model);
    const Pose2& map_T_object = track.places.back().map_T_object;
    const Eigen::Array2d centre = map_T_object.position().array();
    Eigen::AlignedBox3d around;
    around.min() << (centre - body.reach_m).matrix(), 0.0;
    around.max() << (centre + body.reach_m).matrix(), options_.ceiling_m;
    change.extend(map_.clear(around, [&](const Eigen::AlignedBox3d& cell) {
      return overlaps(body.parts, map_T_object.inverse(), cell);
    }));
  }
  return change;
}

LiveMap::Integration LiveMap::integrate(const RangeScan& scan,
                                        const Eigen::Isometry3d& map_T_sensor,
                                        const Pose2& map_T_robot) {
  if (!map_T_sensor.matrix().allFinite() || !map_T_robot.isFinite()) {
    throw InputError("scan of " + scan.sensor, "the pose of the sensor is not finite");
  }
  Integration result;
  const Eigen::Isometry3f to_map = map_T_sensor.cast<float>();
  const Eigen::Vector3f origin = to_map.translation();
  const std::vector<Mask> masks = masksAt(scan.stamp_s, map_T_robot);
  const auto size_m = static_cast<float>(map_.resolution());
  std::vector<SensorRay> rays;
  rays.reserve(scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!scan.points[i].allFinite()) continue;
    SensorRay ray = rayTo(origin, to_map * scan.points[i], masks, &result);
    if (!cutAtHeights(0.0, options_.ceiling_m, origin, &ray)) continue;
    if (ray.hit) ray.blur_m = blurOf(scan, i, size_m);
    rays.push_back(ray);
  }
  result.change = map_.addRays(origin, rays);
  result.change.extend(clearObjects(Clear::kAll));
  return result;
}

}  // namespace casepush
