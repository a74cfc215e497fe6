#include "room_builder.h"

#include <cmath>
#include <utility>

namespace casepush {
namespace {

constexpr double kWallHeight_m = 1.5;
constexpr double kPieceGap_m = 0.05;  // Between pieces of furniture.
constexpr double kWayStep_m = 0.1;
constexpr int kPlaceDraws = 20000;
constexpr double kDegree = M_PI / 180.0;

}  // namespace

double toCentimetre(double value_m) { return std::round(value_m * 100.0) / 100.0; }

double drawHeading(Random& random, double step_deg) {
  return std::round(random.uniform(-180.0, 180.0) / step_deg) * step_deg * kDegree;
}

StaticBox wall(const std::string& name, double length_x_m, double length_y_m, double x_m,
               double y_m) {
  StaticBox box;
  box.name = name;
  box.box.size_m << length_x_m, length_y_m, kWallHeight_m;
  box.map_T_box.translation() << x_m, y_m, 0.5 * kWallHeight_m;
  return box;
}

RoomBuilder::RoomBuilder(const std::string& name, const Eigen::Vector2d& size_m, Random* random)
    : size_m_(size_m), random_(*random) {
  world_.name = name;
  world_.min_m.setZero();
  world_.max_m = size_m;
  const double half_m = 0.5 * kWall_m;
  const double inside_m = size_m.y() - 2.0 * kWall_m;
  const Eigen::Vector2d middle_m = 0.5 * size_m;
  world_.boxes = {
      wall("wall_south", size_m.x(), kWall_m, middle_m.x(), half_m),
      wall("wall_north", size_m.x(), kWall_m, middle_m.x(), size_m.y() - half_m),
      wall("wall_west", kWall_m, inside_m, half_m, middle_m.y()),
      wall("wall_east", kWall_m, inside_m, size_m.x() - half_m, middle_m.y()),
  };
}

RoomBuilder::RoomBuilder(const std::string& name, double size_m, Random* random)
    : RoomBuilder(name, Eigen::Vector2d::Constant(size_m), random) {}

void RoomBuilder::keepFree(const Eigen::Vector2d& centre_m, double radius_m) {
  free_.push_back({centre_m, radius_m});
}

void RoomBuilder::keepLegFree(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                              double radius_m) {
  const int steps = 1 + static_cast<int>((to_m - from_m).norm() / kWayStep_m);
  for (int i = 0; i <= steps; ++i) keepFree(from_m + (to_m - from_m) * i / steps, radius_m);
}

void RoomBuilder::addWall(const StaticBox& box) {
  const Eigen::Vector2d half_m = 0.5 * box.box.size_m.head<2>();
  const Eigen::Vector3d centre = box.map_T_box.translation();
  placed_.push_back(transformed(Pose2(centre.x(), centre.y(), 0.0), rectangle(-half_m, half_m)));
  world_.boxes.push_back(box);
}

double RoomBuilder::furnish(double density) {
  const double floor_m2 = size_m_.prod();
  double covered_m2 = 0.0;
  for (int draw = 0; covered_m2 < density * floor_m2 && draw < kPlaceDraws; ++draw) {
    const FurniturePiece piece = randomFurniture(random_);
    if (tryPlace(piece)) covered_m2 += piece.areaM2();
  }
  return covered_m2 / floor_m2;
}

bool RoomBuilder::placeObject(const std::string& id, const ObjectModel& model, int tag_offset) {
  Shadow disc;
  disc.points[0].setZero();
  disc.count = 1;
  disc.radius_m = model.radius_m;
  for (int draw = 0; draw < kPlaceDraws; ++draw) {
    if (const std::optional<Pose2> pose = tryStand(disc, 1.0)) {
      world_.objects.push_back({id, model.name, *pose, tag_offset});
      return true;
    }
  }
  return false;
}

bool RoomBuilder::tryPlace(const FurniturePiece& piece) {
  const Shadow outline = rectangle(-0.5 * piece.size_m, 0.5 * piece.size_m);
  const std::optional<Pose2> pose = tryStand(outline, 5.0);
  if (!pose) return false;
  ++pieces_;
  add(piece, *pose);
  return true;
}

/// One attempt at a random place.
std::optional<Pose2> RoomBuilder::tryStand(const Shadow& outline, double heading_step_deg) {
  const Eigen::Vector2d inside_m = size_m_.array() - kWall_m;
  const double x = toCentimetre(random_.uniform(kWall_m, inside_m.x()));
  const double y = toCentimetre(random_.uniform(kWall_m, inside_m.y()));
  // Most furniture stands square to the walls.
  const Pose2 pose(x, y, drawHeading(random_, random_.chance(0.7) ? 90.0 : heading_step_deg));
  const Shadow shadow = transformed(pose, outline);
  for (int i = 0; i < shadow.count; ++i) {
    if (shadow.points[i].minCoeff() < kWall_m + shadow.radius_m ||
        (inside_m - shadow.points[i]).minCoeff() < shadow.radius_m) {
      return std::nullopt;
    }
  }
  for (const FreeDisc& disc : free_) {
    if (separation(shadow, disc.centre_m) < disc.radius_m) return std::nullopt;
  }
  for (const Shadow& other : placed_) {
    if (closerThan(shadow, other, kPieceGap_m)) return std::nullopt;
  }
  placed_.push_back(shadow);
  return pose;
}

void RoomBuilder::add(const FurniturePiece& piece, const Pose2& pose) {
  const std::string name = piece.kind + "_" + std::to_string(pieces_);
  for (StaticBox box : piece.boxes) {
    const Eigen::Vector3d centre = box.map_T_box.translation();
    const Eigen::Vector2d map_p = pose * Eigen::Vector2d(centre.head<2>());
    box.name = name + box.name;
    box.map_T_box.translation() << map_p.x(), map_p.y(), centre.z();
    box.map_T_box.linear() =
        Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    world_.boxes.push_back(std::move(box));
  }
}

}  // namespace casepush
