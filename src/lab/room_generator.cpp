#include "casepush/lab/room_generator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "casepush/world/shadow.h"
#include "furniture_kind.h"

namespace casepush {
namespace {

constexpr double kWall_m = 0.1;
constexpr double kWallHeight_m = 1.5;
/// Between furniture and what must stay free, and between pieces of furniture.
constexpr double kGap_m = 0.2;
constexpr double kPieceGap_m = 0.05;
/// The least play that start, bend and goal have, each in x and y.
constexpr double kLeastSpan_m = 2.2;
constexpr double kWayStep_m = 0.1;
constexpr int kWayDraws = 1000;
constexpr int kPlaceDraws = 20000;
constexpr double kDegree = M_PI / 180.0;

double toCentimetre(double value_m) { return std::round(value_m * 100.0) / 100.0; }
double roundTo(double angle_deg, double step_deg) {
  return std::round(angle_deg / step_deg) * step_deg;
}

/// A disc that furniture must not reach into.
struct FreeDisc {
  Eigen::Vector2d centre_m;
  double radius_m;
};

/// Start, bend and goal.
struct Way {
  std::array<Eigen::Vector2d, 3> points;
};

StaticBox wall(const std::string& name, double length_x_m, double length_y_m, double x_m,
               double y_m) {
  StaticBox box;
  box.name = name;
  box.box.size_m << length_x_m, length_y_m, kWallHeight_m;
  box.map_T_box.translation() << x_m, y_m, 0.5 * kWallHeight_m;
  return box;
}

class RoomGenerator {
 public:
  RoomGenerator(const Catalog& catalog, const RoomOptions& options)
      : options_(options),
        object_(catalog.object(options.object)),
        robot_(catalog.robot(options.robot)),
        random_(Random::stream(options.seed, "room")),
        // The robot drives around the object within this distance of the object's origin.
        around_m_(object_.radius_m + 2.0 * robot_.radius_m + kGap_m),
        margin_m_(kWall_m + around_m_),
        span_m_(options.size_m - 2.0 * margin_m_) {}

  WorldModel generate() {
    if (span_m_ < kLeastSpan_m) {
      throw InputError("room size",
                       describe(options_.size_m) + " m is too small for " + object_.name + " and " +
                           robot_.name + "; must be at least " +
                           describe(std::ceil(20.0 * margin_m_ + 10.0 * kLeastSpan_m) / 10.0) +
                           " m");
    }
    world_.name = "room_" + std::to_string(options_.seed);
    world_.min_m.setZero();
    world_.max_m.setConstant(options_.size_m);
    world_.robot = options_.robot;
    buildWalls();
    placeBodies(drawWay());
    furnish();
    return std::move(world_);
  }

 private:
  static std::string describe(double value) {
    std::ostringstream text;
    text.precision(3);
    text << value;
    return text.str();
  }

  void buildWalls() {
    const double s = options_.size_m;
    const double half_m = 0.5 * kWall_m;
    world_.boxes = {
        wall("wall_south", s, kWall_m, 0.5 * s, half_m),
        wall("wall_north", s, kWall_m, 0.5 * s, s - half_m),
        wall("wall_west", kWall_m, s - 2.0 * kWall_m, half_m, 0.5 * s),
        wall("wall_east", kWall_m, s - 2.0 * kWall_m, s - half_m, 0.5 * s),
    };
  }

  Eigen::Vector2d drawPoint() {
    const auto coordinate = [&] {
      return toCentimetre(margin_m_ + random_.uniform(0.005, span_m_ - 0.005));
    };
    const double x = coordinate();
    return {x, coordinate()};
  }

  /// Start and goal far apart, and a bend that makes the way longer but not absurd.
  Way drawWay() {
    for (int i = 0; i < kWayDraws; ++i) {
      const Way way{{drawPoint(), drawPoint(), drawPoint()}};
      const double straight_m = (way.points[2] - way.points[0]).norm();
      const double legs_m =
          (way.points[1] - way.points[0]).norm() + (way.points[2] - way.points[1]).norm();
      if (straight_m > 0.7 * span_m_ && legs_m < 1.6 * straight_m) return way;
    }
    CASEPUSH_CHECK(false, "no way within " << span_m_ << " m");
    return {};
  }

  double drawYaw(double step_deg) {
    return roundTo(random_.uniform(-180.0, 180.0), step_deg) * kDegree;
  }

  void placeBodies(const Way& way) {
    const Eigen::Vector2d start = way.points[0];
    const Eigen::Vector2d goal = way.points[2];
    world_.objects.push_back(
        {"object_1", options_.object, Pose2(start.x(), start.y(), drawYaw(1.0)), 0});
    world_.goal = Pose2(goal.x(), goal.y(), drawYaw(1.0));
    const Eigen::Vector2d ahead = (way.points[1] - start).normalized();
    const Eigen::Vector2d robot =
        start - (object_.radius_m + robot_.radius_m + 0.5 * kGap_m) * ahead;
    world_.map_T_robot = Pose2(robot.x(), robot.y(),
                               roundTo(std::atan2(ahead.y(), ahead.x()) / kDegree, 1.0) * kDegree);
    for (const Eigen::Vector2d& point : way.points) free_.push_back({point, around_m_});
    for (int leg = 0; leg < 2; ++leg) keepLegFree(way.points[leg], way.points[leg + 1]);
  }

  void keepLegFree(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double radius_m = std::max(object_.radius_m, robot_.radius_m) + kGap_m;
    const int steps = 1 + static_cast<int>((to - from).norm() / kWayStep_m);
    for (int i = 0; i <= steps; ++i) {
      free_.push_back({from + (to - from) * i / steps, radius_m});
    }
  }

  void furnish() {
    const double wanted_m2 = options_.density * options_.size_m * options_.size_m;
    double covered_m2 = 0.0;
    for (int draw = 0; covered_m2 < wanted_m2 && draw < kPlaceDraws; ++draw) {
      const FurniturePiece piece = randomFurniture(random_);
      if (tryPlace(piece)) covered_m2 += piece.areaM2();
    }
    if (covered_m2 < wanted_m2) {
      throw InputError("room density",
                       describe(options_.density) + " does not fit: " +
                           describe(covered_m2 / (options_.size_m * options_.size_m)) +
                           " was reached beside the way of the " + object_.name + " in " +
                           describe(options_.size_m) + " m; ask for less or for a larger room");
    }
  }

  bool tryPlace(const FurniturePiece& piece) {
    const double inside_m = options_.size_m - kWall_m;
    const double x = toCentimetre(random_.uniform(kWall_m, inside_m));
    const double y = toCentimetre(random_.uniform(kWall_m, inside_m));
    // Most furniture stands square to the walls.
    const Pose2 pose(x, y, drawYaw(random_.chance(0.7) ? 90.0 : 5.0));
    const Shadow shadow = transformed(pose, rectangle(-0.5 * piece.size_m, 0.5 * piece.size_m));
    for (int i = 0; i < shadow.count; ++i) {
      if (shadow.points[i].minCoeff() < kWall_m || shadow.points[i].maxCoeff() > inside_m) {
        return false;
      }
    }
    for (const FreeDisc& disc : free_) {
      if (separation(shadow, disc.centre_m) < disc.radius_m) return false;
    }
    for (const Shadow& other : placed_) {
      if (closerThan(shadow, other, kPieceGap_m)) return false;
    }
    placed_.push_back(shadow);
    add(piece, pose);
    return true;
  }

  void add(const FurniturePiece& piece, const Pose2& pose) {
    const std::string name = piece.kind + "_" + std::to_string(placed_.size());
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

  const RoomOptions& options_;
  ObjectModel object_;
  RobotModel robot_;
  Random random_;
  double around_m_;
  double margin_m_;
  double span_m_;
  WorldModel world_;
  std::vector<FreeDisc> free_;
  std::vector<Shadow> placed_;
};

}  // namespace

void RoomOptions::validate() const {
  Violations violations;
  violations.require("size", size_m, 2.0, 100.0);
  violations.require("density", density, 0.0, 0.5);
  violations.throwIfAny("room options");
}

WorldModel generateRoom(const Catalog& catalog, const RoomOptions& options) {
  options.validate();
  return RoomGenerator(catalog, options).generate();
}

}  // namespace casepush
