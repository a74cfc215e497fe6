#include "casepush/ros/markers.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

using visualization_msgs::Marker;

constexpr double kFloorOffsetM = 0.02;  // Lines lie just above the floor.
constexpr double kTrajectoryWidthM = 0.02;
constexpr double kCaseSigmas = 2.0;
constexpr int kEllipseSegments = 32;

std_msgs::ColorRGBA colour(double r, double g, double b, double a = 1.0) {
  std_msgs::ColorRGBA result;
  result.r = static_cast<float>(r);
  result.g = static_cast<float>(g);
  result.b = static_cast<float>(b);
  result.a = static_cast<float>(a);
  return result;
}

geometry_msgs::Point point(double x, double y, double z = kFloorOffsetM) {
  geometry_msgs::Point result;
  result.x = x;
  result.y = y;
  result.z = z;
  return result;
}

geometry_msgs::Point point(const Pose2& pose) { return point(pose.x(), pose.y()); }

MarkerArray cleared() {
  MarkerArray array;
  array.markers.emplace_back();
  array.markers.back().header.frame_id = names::kMapFrame;
  array.markers.back().pose.orientation.w = 1.0;
  array.markers.back().action = Marker::DELETEALL;
  return array;
}

/// A new marker in the map frame at the array's end.
Marker& add(MarkerArray& array, const std::string& marker_namespace, int type,
            const std_msgs::ColorRGBA& color, double scale) {
  Marker marker;
  marker.header.frame_id = names::kMapFrame;
  marker.ns = marker_namespace;
  marker.id = static_cast<int>(array.markers.size());
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = scale;
  marker.scale.y = scale;
  marker.scale.z = scale;
  marker.color = color;
  array.markers.push_back(marker);
  return array.markers.back();
}

void addText(MarkerArray& array, const std::string& marker_namespace, const std::string& text,
             const geometry_msgs::Point& where, double height_m) {
  Marker& marker =
      add(array, marker_namespace, Marker::TEXT_VIEW_FACING, colour(1, 1, 1), height_m);
  marker.text = text;
  marker.pose.position = where;
}

void addEllipse(MarkerArray& array, const std::string& marker_namespace,
                const PoseGaussian& gaussian) {
  Marker& marker = add(array, marker_namespace, Marker::LINE_STRIP, colour(1, 0.9, 0.1), 0.015);
  for (const Eigen::Vector2d& p : ellipse(gaussian, kCaseSigmas, kEllipseSegments)) {
    marker.points.push_back(point(p.x(), p.y()));
  }
}

void addArrow(MarkerArray& array, const std::string& marker_namespace, const Pose2& pose,
              double length_m, const std_msgs::ColorRGBA& color) {
  Marker& marker = add(array, marker_namespace, Marker::ARROW, color, length_m);
  marker.scale.y = 0.15 * length_m;
  marker.scale.z = 0.15 * length_m;
  marker.pose = toPoseMessage(pose);
  marker.pose.position.z = kFloorOffsetM;
}

/// Green: the robot while it pushes. Red: the object until it rests.
void addTrajectories(MarkerArray& array, const Case& push_case, const Pose2& map_T_start) {
  Marker robot =
      add(array, "robot trajectory", Marker::LINE_STRIP, colour(0.1, 0.9, 0.2), kTrajectoryWidthM);
  Marker object = add(array, "object trajectory", Marker::LINE_STRIP, colour(0.95, 0.1, 0.1),
                      kTrajectoryWidthM);
  for (std::size_t i = 0; i < push_case.steps.size(); ++i) {
    const CaseStep& step = push_case.steps[i];
    object.points.push_back(point(map_T_start * step.start_T_object));
    if (static_cast<int>(i) < push_case.push_steps) {
      robot.points.push_back(point(map_T_start * step.start_T_robot()));
    }
  }
  array.markers[array.markers.size() - 2].points = robot.points;
  array.markers[array.markers.size() - 1].points = object.points;
}

struct ShapeMarker {
  int type;
  Eigen::Vector3d scale;
};

ShapeMarker shapeMarker(const Shape& shape) {
  if (const Box* box = std::get_if<Box>(&shape)) {
    return {Marker::CUBE, box->size_m};
  }
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&shape)) {
    const double diameter_m = 2.0 * cylinder->radius_m;
    return {Marker::CYLINDER, {diameter_m, diameter_m, cylinder->length_m}};
  }
  return {Marker::SPHERE, Eigen::Vector3d::Constant(2.0 * std::get<Sphere>(shape).radius_m)};
}

void addGoal(MarkerArray& array, const PushPlan& plan) {
  Marker& disc = add(array, "goal", Marker::CYLINDER, colour(0.2, 0.8, 1.0, 0.5),
                     2.0 * plan.tolerance.position_m);
  disc.scale.z = 0.01;
  disc.pose = toPoseMessage(plan.map_T_goal);
  addArrow(array, "goal", plan.map_T_goal, 0.6, colour(0.2, 0.8, 1.0));
}

void addSigmaPoints(MarkerArray& array, const PoseGaussian& map_outcome, double zeta) {
  Marker& marker = add(array, "sigma points", Marker::LINE_LIST, colour(1.0, 0.6, 0.1, 0.9), 0.01);
  constexpr double kTickM = 0.12;
  for (const Pose2& pose : sigmaPoints(map_outcome, zeta)) {
    marker.points.push_back(point(pose));
    marker.points.push_back(point(pose * Pose2(kTickM, 0.0, 0.0)));
  }
}

}  // namespace

std::vector<Eigen::Vector2d> ellipse(const PoseGaussian& gaussian, double sigmas, int segments) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      gaussian.covariance.topLeftCorner<2, 2>());
  const Eigen::Matrix2d root =
      solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2.0 * M_PI * i / segments;
    const Eigen::Vector2d on_circle(std::cos(angle), std::sin(angle));
    // The covariance is given in the frame of the mean.
    const Eigen::Vector2d in_mean = sigmas * (root * on_circle);
    points.push_back(gaussian.mean * in_mean);
  }
  return points;
}

std_msgs::ColorRGBA rainbow(double fraction) {
  const double hue = 4.0 * (1.0 - std::clamp(fraction, 0.0, 1.0));  // 0 red ... 4 blue
  const auto channel = [hue](double centre) {
    return 0.15 + 0.6 * std::clamp(2.0 - std::abs(hue - centre), 0.0, 1.0);  // Muted.
  };
  return colour(channel(0.0), channel(2.0), channel(4.0));
}

void addMechanism(const Mechanism& mechanism, const std::string& frame_id,
                  const Eigen::Isometry3d& frame_T_root, const std::string& marker_namespace,
                  MarkerArray& array) {
  for (std::size_t i = 0; i < mechanism.links.size(); ++i) {
    const Link& link = mechanism.links[i];
    const Eigen::Isometry3d frame_T_link =
        frame_T_root * mechanism.root_T_link(static_cast<int>(i));
    for (const PlacedShape& placed : link.collision) {
      const ShapeMarker shape = shapeMarker(placed.shape);
      const Eigen::Vector4d& rgba = link.colour_rgba;
      Marker& marker =
          add(array, marker_namespace, shape.type, colour(rgba[0], rgba[1], rgba[2], rgba[3]), 1.0);
      marker.header.frame_id = frame_id;
      marker.frame_locked = true;
      marker.scale.x = shape.scale.x();
      marker.scale.y = shape.scale.y();
      marker.scale.z = shape.scale.z();
      marker.pose = toMessage(frame_T_link * placed.frame_T_shape);
    }
  }
}

MarkerArray robotMarkers(const Mechanism& robot) {
  MarkerArray array = cleared();
  addMechanism(robot, names::kBaseFrame, Eigen::Isometry3d::Identity(), "robot", array);
  return array;
}

MarkerArray objectMarkers(const std::vector<ShownObject>& objects, double now_s,
                          double faded_after_s) {
  MarkerArray array = cleared();
  for (const ShownObject& shown : objects) {
    const Pose2& pose = shown.state.map_T_object;
    const std::size_t first = array.markers.size();
    addMechanism(*shown.mechanism, names::kMapFrame, spatialPose(pose), shown.state.id, array);
    if (now_s - shown.state.stamp_s > faded_after_s) {
      for (std::size_t i = first; i < array.markers.size(); ++i) {
        array.markers[i].color.a *= 0.4F;
      }
    }
    addText(array, "object names", shown.state.id, point(pose.x(), pose.y(), 1.4), 0.2);
    addArrow(array, "object heading", pose, 0.5, colour(0.9, 0.9, 0.9));
  }
  return array;
}

MarkerArray caseMarkers(const std::vector<Case>& cases, const Pose2& map_T_object) {
  MarkerArray array = cleared();
  for (const Case& push_case : cases) {
    addTrajectories(array, push_case, map_T_object);
    const PoseGaussian outcome = transform(map_T_object, push_case.start_outcome);
    addEllipse(array, "uncertainty", outcome);
    addArrow(array, "outcome", outcome.mean, 0.2, colour(1, 0.9, 0.1));
    addText(array, "case ids", std::to_string(push_case.id),
            point(outcome.mean.x(), outcome.mean.y(), 0.2), 0.14);
  }
  return array;
}

MarkerArray planMarkers(const PushPlan& plan, const std::vector<Case>& cases) {
  std::map<std::int64_t, const Case*> by_id;
  for (const Case& push_case : cases) {
    by_id[push_case.id] = &push_case;
  }
  MarkerArray array = cleared();
  addGoal(array, plan);
  int number = 0;
  for (const PlannedPush& push : plan.pushes) {
    const auto known = by_id.find(push.case_id);
    if (known != by_id.end()) {
      addTrajectories(array, *known->second, push.map_T_start);
    }
    addEllipse(array, "uncertainty", push.map_outcome);
    addSigmaPoints(array, push.map_outcome, plan.zeta);
    const Pose2& end = push.map_outcome.mean;
    addArrow(array, "outcome", end, 0.25, colour(1, 0.9, 0.1));
    addText(array, "push numbers", std::to_string(++number), point(end.x(), end.y(), 0.3), 0.18);
  }
  return array;
}

MarkerArray treeMarkers(const std::vector<TreeEdge>& tree) {
  MarkerArray array = cleared();
  Marker& marker = add(array, "tree", Marker::LINE_LIST, colour(0.5, 0.5, 0.9, 0.5), 0.006);
  for (const TreeEdge& edge : tree) {
    marker.points.push_back(point(edge.from));
    marker.points.push_back(point(edge.to));
  }
  return array;
}

MarkerArray mapMarkers(const Map& map) {
  MarkerArray array = cleared();
  if (map.empty()) {
    return array;
  }
  const double low_m = map.min().z();
  const double high_m = std::max(map.max().z(), low_m + map.resolution());
  std::map<float, std::size_t> marker_of_size;
  for (const Map::Voxel& voxel : map.occupied()) {
    const auto found = marker_of_size.find(voxel.size_m);
    if (found == marker_of_size.end()) {
      marker_of_size[voxel.size_m] = array.markers.size();
      add(array, "voxels", Marker::CUBE_LIST, colour(1, 1, 1), voxel.size_m);
    }
    Marker& marker = array.markers[marker_of_size[voxel.size_m]];
    const Eigen::Vector3f& centre = voxel.centre_m;
    marker.points.push_back(point(centre.x(), centre.y(), centre.z()));
    marker.colors.push_back(rainbow((centre.z() - low_m) / (high_m - low_m)));
  }
  return array;
}

}  // namespace casepush
