#include "casepush/lab/divided_room.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "room_builder.h"

namespace casepush {
namespace {

constexpr double kGap_m = 0.2;     // Between furniture and what must stay free.
constexpr double kSpare_m = 0.3;   // Doors and ends do not stand exactly as near as they may.
constexpr double kStray_m = 0.05;  // Of what stands in the door.
// Where measures are drawn:
constexpr std::uint64_t kMostInDoor = 2;
constexpr double kPassing_m = 0.6;          // A door is so much wider than the object, at least,
constexpr double kBesideObstacle_m = 0.15;  // and than what stands in it, for each of these,
constexpr double kDoorPlay_m = 0.4;         // and up to so much wider than that.

/// The robot drives around the object within this distance of the object's origin.
double aroundM(const ObjectModel& object, const RobotModel& robot) {
  return object.radius_m + 2.0 * robot.radius_m + kGap_m;
}

/// Of the middles of the doors: they do not meet.
double leastApartM(double door_m) { return door_m + kWall_m; }

/// The robot gets around the object at start and goal, and in the door.
double leastDepthM(double around_m) { return 3.0 * kWall_m + 4.0 * around_m + 2.0 * kSpare_m; }

void requireAtLeast(const char* what, double value_m, double least_m) {
  if (value_m >= least_m) return;
  throw InputError(what, std::to_string(value_m) + " m is too small; must be at least " +
                             std::to_string(least_m) + " m");
}

class DividedRoom {
 public:
  DividedRoom(const Catalog& catalog, const DividedRoomOptions& options)
      : options_(options),
        object_(catalog.object(options.object)),
        robot_(catalog.robot(options.robot)),
        random_(Random::stream(options.seed, "divided room")),
        size_m_(options.size_m, options.depth_m.value_or(options.size_m)),
        builder_("divided_room_" + std::to_string(options.seed), size_m_, &random_),
        around_m_(aroundM(object_, robot_)) {}

  WorldModel generate() {
    const double apart_m =
        options_.doors_apart_m.value_or(leastApartM(options_.door_m) + 2.0 * kSpare_m);
    const double side_m = kWall_m + around_m_;
    requireAtLeast("room size", size_m_.x(), 2.0 * side_m + apart_m);
    requireAtLeast("room depth", size_m_.y(), leastDepthM(around_m_));
    requireAtLeast("distance of the doors", apart_m, leastApartM(options_.door_m));
    if (options_.doors_apart_m) {
      near_m_ = toCentimetre(side_m + random_.uniform(0.0, size_m_.x() - 2.0 * side_m - apart_m));
      far_m_ = near_m_ + toCentimetre(apart_m);
    } else {
      near_m_ = toCentimetre(side_m + random_.uniform(0.0, kSpare_m));
      far_m_ = toCentimetre(size_m_.x() - side_m - random_.uniform(0.0, kSpare_m));
    }
    divide();
    placeEnds();
    blockDoor();
    builder_.furnish(options_.density);
    builder_.world().robot = options_.robot;
    return std::move(builder_.world());
  }

 private:
  double middle() const { return 0.5 * size_m_.y(); }

  void divide() {
    const double half_m = 0.5 * options_.door_m;
    const double ends[][2] = {{kWall_m, near_m_ - half_m},
                              {near_m_ + half_m, far_m_ - half_m},
                              {far_m_ + half_m, size_m_.x() - kWall_m}};
    int number = 0;
    for (const auto& [from_m, to_m] : ends) {
      if (to_m - from_m < kWall_m) continue;
      builder_.addWall(wall("wall_between_" + std::to_string(++number), to_m - from_m, kWall_m,
                            0.5 * (from_m + to_m), middle()));
    }
  }

  void placeEnds() {
    const auto beside = [this] {
      const double least_m = kWall_m + around_m_;
      const double x_m = near_m_ + random_.uniform(-options_.play_m, options_.play_m);
      return toCentimetre(std::clamp(x_m, least_m, size_m_.x() - least_m));
    };
    const double back_m = kWall_m + around_m_;
    const Eigen::Vector2d start(beside(), toCentimetre(back_m + random_.uniform(0.0, kSpare_m)));
    const Eigen::Vector2d goal(beside(),
                               toCentimetre(size_m_.y() - back_m - random_.uniform(0.0, kSpare_m)));
    WorldModel& world = builder_.world();
    world.objects.push_back(
        {"object_1", options_.object, Pose2(start.x(), start.y(), drawHeading(random_, 1.0)), 0});
    world.goal = Pose2(goal.x(), goal.y(), drawHeading(random_, 1.0));
    world.map_T_robot =
        Pose2(start.x(), start.y() - object_.radius_m - robot_.radius_m - 0.5 * kGap_m, 0.5 * M_PI);
    keepWaysFree(start, goal);
  }

  void keepWaysFree(const Eigen::Vector2d& start, const Eigen::Vector2d& goal) {
    const Eigen::Vector2d near(near_m_, middle());
    const Eigen::Vector2d far(far_m_, middle());
    for (const Eigen::Vector2d& place : {start, goal, near, far}) {
      builder_.keepFree(place, around_m_);
    }
    const Eigen::Vector2d before(far_m_, start.y());
    const Eigen::Vector2d behind(far_m_, goal.y());
    const double passing_m = around_m_ - robot_.radius_m;
    builder_.keepLegFree(start, near, passing_m);
    builder_.keepLegFree(near, goal, passing_m);
    builder_.keepLegFree(start, before, passing_m);
    builder_.keepLegFree(before, behind, passing_m);
    builder_.keepLegFree(behind, goal, passing_m);
  }

  /// Evenly over the width of the near door.
  void blockDoor() {
    const auto count = static_cast<int>(options_.movable.size());
    for (int i = 0; i < count; ++i) {
      const double x_m = near_m_ + options_.door_m * ((i + 0.5) / count - 0.5);
      const auto stray = [this] { return random_.uniform(-kStray_m, kStray_m); };
      const double x = toCentimetre(x_m + stray());
      const double y = toCentimetre(middle() + stray());
      builder_.world().objects.push_back({"movable_" + std::to_string(i + 1), options_.movable[i],
                                          Pose2(x, y, drawHeading(random_, 1.0)),
                                          (i + 1) * kTagsPerObject});
    }
  }

  const DividedRoomOptions& options_;
  ObjectModel object_;
  RobotModel robot_;
  Random random_;
  Eigen::Vector2d size_m_;
  RoomBuilder builder_;
  double around_m_;
  double near_m_ = 0.0;
  double far_m_ = 0.0;
};

}  // namespace

void DividedRoomOptions::validate() const {
  Violations violations;
  violations.require("size", size_m, 2.0, 100.0);
  violations.require("depth", depth_m.value_or(size_m), 2.0, 100.0);
  violations.require("density", density, 0.0, 0.5);
  violations.require("door", door_m, 0.5, 10.0);
  violations.require("distance of the doors", doors_apart_m.value_or(door_m), 0.0, 100.0);
  violations.require("play", play_m, 0.0, 10.0);
  violations.require("number of movable objects", static_cast<double>(movable.size()), 0, 5);
  violations.throwIfAny("divided room options");
}

WorldModel generateDividedRoom(const Catalog& catalog, const DividedRoomOptions& options) {
  options.validate();
  return DividedRoom(catalog, options).generate();
}

DividedRoomOptions drawDividedRoom(const Catalog& catalog, DividedRoomOptions options) {
  if (options.movable.empty()) {
    throw InputError("movable objects", "there are none to draw from; name at least one");
  }
  const ObjectModel object = catalog.object(options.object);
  const double around_m = aroundM(object, catalog.robot(options.robot));
  Random random = Random::stream(options.seed, "measures of a divided room");
  std::vector<std::string> in_door;
  double widest_m = 0.0;
  const std::uint64_t count = 1 + random.below(kMostInDoor);
  while (in_door.size() < count) {
    in_door.push_back(options.movable[random.below(options.movable.size())]);
    widest_m = std::max(widest_m, 2.0 * catalog.object(in_door.back()).radius_m);
  }
  options.movable = std::move(in_door);
  const double least_door_m = std::max(2.0 * object.radius_m + kPassing_m,
                                       static_cast<double>(count) * (widest_m + kBesideObstacle_m));
  options.door_m = toCentimetre(least_door_m + random.uniform(0.0, kDoorPlay_m));
  const double least_m = 2.0 * (kWall_m + around_m) + leastApartM(options.door_m) + kSpare_m;
  options.size_m = toCentimetre(std::max(random.uniform(8.0, 14.0), least_m));
  const double most_apart_m = options.size_m - 2.0 * (kWall_m + around_m);
  options.doors_apart_m =
      toCentimetre(random.uniform(leastApartM(options.door_m) + 0.01, most_apart_m - 0.01));
  options.depth_m =
      toCentimetre(std::max(random.uniform(6.0, 10.0), leastDepthM(around_m) + kSpare_m));
  options.play_m = 1.5;
  return options;
}

}  // namespace casepush
