#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "casepush/common/pose2.h"
#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"

namespace casepush {

/// Fraction of the segment from `begin` to `end` (in the shape's frame) at which it enters a slab
/// |x_axis| <= half and leaves it; [0, 1] is cut down to that.
inline void clip(double begin, double end, double half, std::array<double, 2>* range) {
  const double step = end - begin;
  if (std::abs(step) < 1e-12) {
    if (std::abs(begin) > half) {
      *range = {1.0, 0.0};
    }
    return;
  }
  const double a = (-half - begin) / step;
  const double b = (half - begin) / step;
  (*range)[0] = std::max((*range)[0], std::min(a, b));
  (*range)[1] = std::min((*range)[1], std::max(a, b));
}

/// True if the segment meets the shape, a box or a cylinder.
inline bool isHit(const PlacedShape& placed, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to) {
  const Eigen::Isometry3d shape_T_frame = placed.frame_T_shape.inverse();
  const Eigen::Vector3d a = shape_T_frame * from;
  const Eigen::Vector3d b = shape_T_frame * to;
  std::array<double, 2> range{0.0, 1.0};
  if (const auto* box = std::get_if<Box>(&placed.shape)) {
    for (int i = 0; i < 3; ++i) {
      clip(a(i), b(i), 0.5 * box->size_m(i), &range);
    }
    return range[0] < range[1];
  }
  const auto& cylinder = std::get<Cylinder>(placed.shape);
  clip(a.z(), b.z(), 0.5 * cylinder.length_m, &range);
  const Eigen::Vector2d step = (b - a).head<2>();
  const double t = step.squaredNorm() > 0.0 ? -a.head<2>().dot(step) / step.squaredNorm() : 0.0;
  const double nearest_t = std::clamp(t, range[0], std::max(range[0], range[1]));
  return range[0] < range[1] && (a.head<2>() + nearest_t * step).norm() < cylinder.radius_m;
}

inline bool isBlocked(const Solid& solid, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return std::any_of(solid.begin(), solid.end(),
                     [&](const PlacedShape& shape) { return isHit(shape, from, to); });
}

inline Eigen::Isometry3d toIsometry(const Pose2& pose) {
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.translate(Eigen::Vector3d(pose.x(), pose.y(), 0.0));
  isometry.rotate(Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ()));
  return isometry;
}

/// True if the camera sees the whole tag: in range, in the image, at a fair angle, not occluded.
inline bool sees(const RobotModel& robot, const CameraModel& camera, const ObjectModel& object,
                 const TagMount& tag, const Pose2& object_T_robot) {
  const Eigen::Isometry3d object_T_base = toIsometry(object_T_robot);
  const Eigen::Isometry3d camera_T_tag =
      (object_T_base * camera.base_T_camera).inverse() * tag.object_T_tag;
  const Eigen::Vector3d sight = camera_T_tag.translation();
  const double cosine = sight.normalized().dot(camera_T_tag.linear().col(2));
  if (sight.norm() > camera.max_range_m || cosine < std::cos(camera.max_view_angle_rad)) {
    return false;
  }
  const Eigen::Vector3d object_camera = (object_T_base * camera.base_T_camera).translation();
  const Eigen::Isometry3d base_T_object = object_T_base.inverse();
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, 0}}) {
    const Eigen::Vector3d tag_p(0.5 * tag.size_m * u, 0.5 * tag.size_m * v, 0.0);
    const Eigen::Vector3d camera_p = camera_T_tag * tag_p;
    const double focal_px = camera.focalPx();
    if (camera_p.z() <= 0.0 ||
        std::abs(focal_px * camera_p.x() / camera_p.z()) > 0.5 * camera.width_px ||
        std::abs(focal_px * camera_p.y() / camera_p.z()) > 0.5 * camera.height_px) {
      return false;
    }
    const Eigen::Vector3d object_p = tag.object_T_tag * tag_p;
    if (isBlocked(object.solid, object_camera, object_p) ||
        isBlocked(robot.solid, base_T_object * object_camera, base_T_object * object_p)) {
      return false;
    }
  }
  return true;
}

/// Number of tags that at least one of the robot's cameras sees.
inline int visibleTags(const RobotModel& robot, const ObjectModel& object,
                       const Pose2& object_T_robot) {
  return static_cast<int>(
      std::count_if(object.tags.begin(), object.tags.end(), [&](const TagMount& tag) {
        return std::any_of(robot.cameras.begin(), robot.cameras.end(),
                           [&](const CameraModel& camera) {
                             return sees(robot, camera, object, tag, object_T_robot);
                           });
      }));
}

/// Points on the outline of an upright box or cylinder on the floor.
inline std::vector<Eigen::Vector2d> outline(const PlacedShape& placed) {
  constexpr int kPoints = 200;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < kPoints; ++i) {
    const double angle_rad = 2.0 * M_PI * i / kPoints;
    Eigen::Vector3d p(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    if (const auto* box = std::get_if<Box>(&placed.shape)) {
      p *= 0.5 / (p.cwiseAbs().cwiseQuotient(box->size_m)).maxCoeff();
    } else {
      p *= std::get<Cylinder>(placed.shape).radius_m;
    }
    points.push_back((placed.frame_T_shape * p).head<2>());
  }
  return points;
}

/// How far from the object's origin, along the given direction in its frame, a robot made of
/// upright cylinders around its axis touches the object if it passes the origin at `offset_m` to
/// the left of that direction; nothing if it misses the object.
inline std::optional<double> contactDistance(const RobotModel& robot, const ObjectModel& object,
                                             double direction_rad, double offset_m = 0.0) {
  const Eigen::Vector2d direction(std::cos(direction_rad), std::sin(direction_rad));
  const Eigen::Vector2d normal(-direction.y(), direction.x());
  std::optional<double> distance_m;
  for (const PlacedShape& part : robot.solid) {
    const double radius_m = std::get<Cylinder>(part.shape).radius_m;
    const HeightRange part_height = heightRange(part);
    for (const PlacedShape& shape : object.solid) {
      const HeightRange height = heightRange(shape);
      if (height.high_m <= part_height.low_m || height.low_m >= part_height.high_m) {
        continue;
      }
      for (const Eigen::Vector2d& p : outline(shape)) {
        const double across_m = p.dot(normal) - offset_m;
        if (std::abs(across_m) < radius_m) {
          const double touch_m =
              p.dot(direction) + std::sqrt(radius_m * radius_m - across_m * across_m);
          distance_m = std::max(distance_m.value_or(touch_m), touch_m);
        }
      }
    }
  }
  return distance_m;
}

}  // namespace casepush
