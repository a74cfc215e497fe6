#include <algorithm>
#include <cmath>
#include <cstring>

#include "casepush/common/input_error.h"
#include "casepush/ros/conversions.h"
#include "casepush/ros/names.h"

namespace casepush {
namespace {

constexpr char kTreeId[] = "OcTree";

/// Byte offset of a float32 field. @throws InputError if there is none.
std::uint32_t fieldOffset(const sensor_msgs::PointCloud2& message, const std::string& name) {
  for (const sensor_msgs::PointField& field : message.fields) {
    if (field.name == name && field.datatype == sensor_msgs::PointField::FLOAT32 &&
        field.count == 1) {
      if (field.offset + sizeof(float) > message.point_step) {
        throw InputError("point cloud", "field " + name + " lies outside of a point");
      }
      return field.offset;
    }
  }
  throw InputError("point cloud", "has no field " + name + " of type float32");
}

void checkSize(const sensor_msgs::PointCloud2& message) {
  if (message.is_bigendian) {
    throw InputError("point cloud", "is big-endian; only little-endian clouds are read");
  }
  const std::uint64_t row = std::uint64_t{message.width} * message.point_step;
  const std::uint64_t all = std::uint64_t{message.height} * message.row_step;
  if (message.row_step < row || message.data.size() < all) {
    throw InputError("point cloud", "holds " + std::to_string(message.data.size()) +
                                        " bytes, fewer than its size says");
  }
}

sensor_msgs::PointCloud2 cloud(const std::vector<Eigen::Vector3f>& points, int rows,
                               const std::string& frame, double stamp_s) {
  sensor_msgs::PointCloud2 message;
  message.header.stamp = toRosTime(stamp_s);
  message.header.frame_id = frame;
  message.height = static_cast<std::uint32_t>(rows);
  message.width = static_cast<std::uint32_t>(points.size()) / message.height;
  for (const char* name : {"x", "y", "z"}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(message.fields.size() * sizeof(float));
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.point_step = 3 * sizeof(float);
  message.row_step = message.point_step * message.width;
  message.is_dense = false;
  message.data.resize(message.row_step * message.height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(&message.data[i * message.point_step], points[i].data(), message.point_step);
  }
  return message;
}

}  // namespace

sensor_msgs::PointCloud2 toMessage(const std::vector<Eigen::Vector3f>& map_points, double stamp_s) {
  sensor_msgs::PointCloud2 message = cloud(map_points, 1, names::kMapFrame, stamp_s);
  message.is_dense = true;
  return message;
}

sensor_msgs::PointCloud2 toMessage(const RangeScan& scan) {
  return cloud(scan.points, scan.layers, rangeFrame(scan.sensor), scan.stamp_s);
}

RangeScan scanFromMessage(const sensor_msgs::PointCloud2& message) {
  checkSize(message);
  const std::uint32_t offsets[] = {fieldOffset(message, "x"), fieldOffset(message, "y"),
                                   fieldOffset(message, "z")};
  RangeScan scan{message.header.frame_id,
                 message.header.stamp.toSec(),
                 static_cast<int>(message.height),
                 static_cast<int>(message.width),
                 {}};
  scan.points.reserve(std::size_t{message.width} * message.height);
  for (std::uint32_t row = 0; row < message.height; ++row) {
    for (std::uint32_t column = 0; column < message.width; ++column) {
      const std::uint8_t* start = message.data.data() + std::size_t{row} * message.row_step +
                                  std::size_t{column} * message.point_step;
      Eigen::Vector3f point;
      for (int axis = 0; axis < 3; ++axis) {
        std::memcpy(&point[axis], start + offsets[axis], sizeof(float));
      }
      scan.points.push_back(point);
    }
  }
  return scan;
}

std::vector<Eigen::Vector3f> fromMessage(const sensor_msgs::PointCloud2& message) {
  std::vector<Eigen::Vector3f> points = scanFromMessage(message).points;
  points.erase(std::remove_if(points.begin(), points.end(),
                              [](const Eigen::Vector3f& point) { return !point.allFinite(); }),
               points.end());
  return points;
}

OccupancyGrid fromMessage(const nav_msgs::OccupancyGrid& message) {
  const Eigen::Isometry3d origin = fromMessage(message.info.origin);
  if (origin.linear()(2, 2) < 0.999 || std::abs(origin.translation().z()) > 0.01) {
    throw InputError("topic map", "its origin is tilted or off the floor");
  }
  OccupancyGrid grid;
  grid.width = static_cast<int>(std::min<std::uint32_t>(message.info.width, 1U << 30));
  grid.height = static_cast<int>(std::min<std::uint32_t>(message.info.height, 1U << 30));
  grid.resolution_m = message.info.resolution;
  grid.map_T_grid = planarPose(origin);
  grid.cells.assign(message.data.begin(), message.data.end());
  return grid;
}

Octomap toMessage(const Map& map, double stamp_s) {
  Octomap message;
  message.header.stamp = toRosTime(stamp_s);
  message.header.frame_id = names::kMapFrame;
  message.binary = true;
  message.id = kTreeId;
  message.resolution = map.resolution();
  message.data = map.toBinary();
  return message;
}

Map fromMessage(const Octomap& message) {
  if (!message.binary || message.id != kTreeId) {
    throw InputError("octomap message", "is no binary OcTree (id '" + message.id + "')");
  }
  return Map::fromBinary(message.resolution, message.data);
}

}  // namespace casepush
