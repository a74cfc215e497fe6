#include "casepush/world/fcl_checker.h"

#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/utility.h>
#include <fcl/narrowphase/collision.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <utility>

#include "casepush/world/shadow.h"

namespace casepush {
namespace {

using Part = std::pair<std::shared_ptr<fcl::CollisionGeometryd>, Eigen::Isometry3d>;

std::shared_ptr<fcl::CollisionGeometryd> geometry(const Shape& shape, double shrink_m) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Eigen::Vector3d size = box->size_m.array() - 2.0 * shrink_m;
    return std::make_shared<fcl::Boxd>(size);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return std::make_shared<fcl::Cylinderd>(cylinder->radius_m - shrink_m,
                                            cylinder->length_m - 2.0 * shrink_m);
  }
  return std::make_shared<fcl::Sphered>(std::get<Sphere>(shape).radius_m - shrink_m);
}

Eigen::Isometry3d inSpace(const Pose2& pose) {
  return Eigen::Translation3d(pose.x(), pose.y(), 0.0) *
         Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ());
}

bool overlap(const Part& a, const Eigen::Isometry3d& map_T_a, const Part& b,
             const Eigen::Isometry3d& map_T_b) {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(a.first.get(), map_T_a * a.second, b.first.get(), map_T_b * b.second, request,
                      result) > 0;
}

/// The smallest box along the axes.
fcl::AABBd boundsOf(const fcl::CollisionGeometryd& shape, const Eigen::Isometry3d& map_T_shape) {
  fcl::AABBd bounds;
  if (const auto* box = dynamic_cast<const fcl::Boxd*>(&shape)) {
    fcl::computeBV(*box, map_T_shape, bounds);
  } else if (const auto* cylinder = dynamic_cast<const fcl::Cylinderd*>(&shape)) {
    // FCL's own box around a cylinder is that around its box.
    const Eigen::Vector3d axis = map_T_shape.linear().col(2);
    const Eigen::Vector3d across = (1.0 - axis.array().square()).max(0.0).sqrt();
    const Eigen::Vector3d half = cylinder->radius * across + cylinder->lz / 2.0 * axis.cwiseAbs();
    bounds = fcl::AABBd(map_T_shape.translation() - half, map_T_shape.translation() + half);
  } else {
    fcl::computeBV(dynamic_cast<const fcl::Sphered&>(shape), map_T_shape, bounds);
  }
  return bounds;
}

/// The map's tree without the floor.
std::shared_ptr<octomap::OcTree> standing(const Map& map, double floor_m) {
  const double cell_m = map.resolution();
  auto tree = std::make_shared<octomap::OcTree>(cell_m);
  const double lowest = std::floor((floor_m + kContactTolerance_m) / cell_m);
  for (const Map::Voxel& voxel : map.occupied()) {
    const auto count = std::lround(voxel.size_m / cell_m);
    const Eigen::Vector3d corner = voxel.centre_m.cast<double>().array() - voxel.size_m / 2.0;
    for (long i = 0; i < count * count * count; ++i) {
      const Eigen::Vector3d index(i % count, i / count % count, i / (count * count));
      const Eigen::Vector3d centre = corner.array() + (index.array() + 0.5) * cell_m;
      if (centre.z() < lowest * cell_m) continue;
      tree->setNodeValue(centre.x(), centre.y(), centre.z(), tree->getClampingThresMaxLog(), true);
    }
  }
  tree->updateInnerOccupancy();
  tree->prune();
  return tree;
}

}  // namespace

struct FclChecker::Body::Data {
  std::vector<Part> parts;
};

FclChecker::Body::Body(const Solid& solid, double shrink_m) : data_(std::make_unique<Data>()) {
  for (const PlacedShape& shape : solid) {
    data_->parts.emplace_back(geometry(shape.shape, shrink_m), shape.frame_T_shape);
  }
}

FclChecker::Body::~Body() = default;
FclChecker::Body::Body(Body&&) noexcept = default;

struct FclChecker::Data {
  Part map;
  bool has_cells = false;
  Eigen::Vector2d min_m{0.0, 0.0};
  Eigen::Vector2d max_m{0.0, 0.0};
  struct Obstacle {
    Part part;
    Eigen::Isometry3d map_T_obstacle;
  };
  std::vector<Obstacle> obstacles;
};

bool FclChecker::isAvailable() { return true; }

FclChecker::FclChecker(const Map& map, double floor_m) : data_(std::make_unique<Data>()) {
  if (map.empty()) return;
  const std::shared_ptr<octomap::OcTree> tree = standing(map, floor_m);
  data_->has_cells = tree->size() > 0;
  data_->map = {std::make_shared<fcl::OcTreed>(tree), Eigen::Isometry3d::Identity()};
  data_->min_m = map.min().head<2>();
  data_->max_m = map.max().head<2>();
}

FclChecker::~FclChecker() = default;

void FclChecker::setObstacles(const std::vector<PlacedSolid>& obstacles) {
  data_->obstacles.clear();
  for (const PlacedSolid& placed : obstacles) {
    for (const PlacedShape& shape : placed.solid) {
      data_->obstacles.push_back(
          {{geometry(shape.shape, 0.0), shape.frame_T_shape}, inSpace(placed.map_T_solid)});
    }
  }
}

bool FclChecker::collides(const Body& body, const Pose2& map_T_body) const {
  const Eigen::Isometry3d pose = inSpace(map_T_body);
  for (const Part& part : body.data_->parts) {
    const fcl::AABBd bounds = boundsOf(*part.first, pose * part.second);
    if ((bounds.min_.head<2>().array() < data_->min_m.array() - kContactTolerance_m).any() ||
        (bounds.max_.head<2>().array() > data_->max_m.array() + kContactTolerance_m).any()) {
      return true;
    }
  }
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  for (const Part& part : body.data_->parts) {
    if (data_->has_cells && overlap(part, pose, data_->map, identity)) return true;
    for (const Data::Obstacle& obstacle : data_->obstacles) {
      if (overlap(part, pose, obstacle.part, obstacle.map_T_obstacle)) return true;
    }
  }
  return false;
}

}  // namespace casepush
