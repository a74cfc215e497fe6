#include "casepush/lab/divided_room.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "room_builder.h"

namespace casepush {
namespace {

constexpr double kGap_m = 0.2;     // Between furniture and what must stay free.
constexpr double kPlay_m = 0.5;    // Of start and goal beside the door's axis.
constexpr double kStray_m = 0.05;  // Of what stands in the door.

class DividedRoom {
 public:
  DividedRoom(const Catalog& catalog, const DividedRoomOptions& options)
      : options_(options),
        object_(catalog.object(options.object)),
        robot_(catalog.robot(options.robot)),
        random_(Random::stream(options.seed, "divided room")),
        builder_("divided_room_" + std::to_string(options.seed), options.size_m, &random_),
        around_m_(object_.radius_m + 2.0 * robot_.radius_m + kGap_m) {}

  WorldModel generate() {
    const double needed_m = 2.0 * kWall_m + 2.0 * options_.door_m + 2.0 * around_m_;
    if (options_.size_m < needed_m) {
      throw InputError("room size", std::to_string(options_.size_m) +
                                        " m is too small for two doors; must be at least " +
                                        std::to_string(needed_m) + " m");
    }
    const double side_m = kWall_m + around_m_;
    near_m_ = toCentimetre(side_m + random_.uniform(0.0, 0.3));
    far_m_ = toCentimetre(options_.size_m - side_m - random_.uniform(0.0, 0.3));
    divide();
    placeEnds();
    blockDoor();
    builder_.furnish(options_.density);
    builder_.world().robot = options_.robot;
    return std::move(builder_.world());
  }

 private:
  double middle() const { return 0.5 * options_.size_m; }

  void divide() {
    const double half_m = 0.5 * options_.door_m;
    const double ends[][2] = {{kWall_m, near_m_ - half_m},
                              {near_m_ + half_m, far_m_ - half_m},
                              {far_m_ + half_m, options_.size_m - kWall_m}};
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
      return toCentimetre(std::max(least_m, near_m_ + random_.uniform(-kPlay_m, kPlay_m)));
    };
    const double back_m = kWall_m + around_m_;
    const Eigen::Vector2d start(beside(), toCentimetre(back_m + random_.uniform(0.0, 0.3)));
    const Eigen::Vector2d goal(beside(),
                               toCentimetre(options_.size_m - back_m - random_.uniform(0.0, 0.3)));
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
  RoomBuilder builder_;
  double around_m_;
  double near_m_ = 0.0;
  double far_m_ = 0.0;
};

}  // namespace

void DividedRoomOptions::validate() const {
  Violations violations;
  violations.require("size", size_m, 2.0, 100.0);
  violations.require("density", density, 0.0, 0.5);
  violations.require("door", door_m, 0.5, 10.0);
  violations.require("number of movable objects", static_cast<double>(movable.size()), 0, 5);
  violations.throwIfAny("divided room options");
}

WorldModel generateDividedRoom(const Catalog& catalog, const DividedRoomOptions& options) {
  options.validate();
  return DividedRoom(catalog, options).generate();
}

}  // namespace casepush
