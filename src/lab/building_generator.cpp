#include "casepush/lab/building_generator.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "room_builder.h"

namespace casepush {
namespace {

constexpr double kGap_m = 0.2;       // Between furniture and what must stay free.
constexpr double kDoorPlay_m = 1.5;  // Of doors along their walls.

class Building {
 public:
  Building(const Catalog& catalog, const BuildingOptions& options)
      : options_(options),
        object_(catalog.object(options.object)),
        robot_(catalog.robot(options.robot)),
        random_(Random::stream(options.seed, "building")),
        builder_("building_" + std::to_string(options.seed), options.size_m, &random_),
        count_(std::max(1, static_cast<int>(std::lround(options.size_m / options.room_m)))),
        room_m_(options.size_m / count_) {}

  WorldModel generate() {
    for (int i = 1; i < count_; ++i) {
      for (int k = 0; k < count_; ++k) {
        divide(i, k, true);
        divide(i, k, false);
      }
    }
    placeBodies();
    builder_.furnish(options_.density);
    builder_.world().robot = options_.robot;
    return std::move(builder_.world());
  }

 private:
  Eigen::Vector2d middle(int column, int row) const {
    return {(column + 0.5) * room_m_, (row + 0.5) * room_m_};
  }

  /// The wall with its door between two rooms side by side (`upright`) or one above the other.
  void divide(int line, int room, bool upright) {
    const double at_m = line * room_m_;
    const double from_m = std::max(kWall_m, room * room_m_);
    const double to_m = std::min(options_.size_m - kWall_m, (room + 1) * room_m_);
    const double play_m = std::min(kDoorPlay_m, 0.5 * (room_m_ - options_.door_m) - 0.5);
    const double door_m = toCentimetre((room + 0.5) * room_m_ + random_.uniform(-play_m, play_m));
    const double half_m = 0.5 * options_.door_m;
    const std::string name = std::string(upright ? "wall_x" : "wall_y") + std::to_string(line) +
                             "_" + std::to_string(room);
    addPiece(name + "_a", at_m, from_m, door_m - half_m, upright);
    addPiece(name + "_b", at_m, door_m + half_m, to_m, upright);
    const Eigen::Vector2d door =
        upright ? Eigen::Vector2d(at_m, door_m) : Eigen::Vector2d(door_m, at_m);
    const double passing_m = object_.radius_m + robot_.radius_m + kGap_m;
    builder_.keepLegFree(upright ? middle(line - 1, room) : middle(room, line - 1), door,
                         passing_m);
    builder_.keepLegFree(door, upright ? middle(line, room) : middle(room, line), passing_m);
  }

  void addPiece(const std::string& name, double at_m, double from_m, double to_m, bool upright) {
    const double length_m = to_m - from_m;
    const double centre_m = 0.5 * (from_m + to_m);
    // Where walls cross, those along y give way.
    const double shorter_m = upright ? length_m - kWall_m : length_m;
    builder_.addWall(upright ? wall(name, kWall_m, shorter_m, at_m, centre_m)
                             : wall(name, shorter_m, kWall_m, centre_m, at_m));
  }

  void placeBodies() {
    const double around_m = object_.radius_m + 2.0 * robot_.radius_m + kGap_m;
    const Eigen::Vector2d start = middle(0, 0);
    const Eigen::Vector2d goal = middle(count_ - 1, count_ - 1);
    for (int column = 0; column < count_; ++column) {
      for (int row = 0; row < count_; ++row) builder_.keepFree(middle(column, row), around_m);
    }
    WorldModel& world = builder_.world();
    world.objects.push_back(
        {"object_1", options_.object, Pose2(start.x(), start.y(), drawHeading(random_, 1.0)), 0});
    world.goal = Pose2(goal.x(), goal.y(), drawHeading(random_, 1.0));
    world.map_T_robot =
        Pose2(start.x() - object_.radius_m - robot_.radius_m - 0.5 * kGap_m, start.y(), 0.0);
  }

  const BuildingOptions& options_;
  ObjectModel object_;
  RobotModel robot_;
  Random random_;
  RoomBuilder builder_;
  int count_;
  double room_m_;
};

}  // namespace

void BuildingOptions::validate() const {
  Violations violations;
  violations.require("size", size_m, 6.0, 200.0);
  violations.require("room", room_m, 6.0, 50.0);
  violations.require("door", door_m, 1.0, 3.0);
  violations.require("density", density, 0.0, 0.5);
  violations.throwIfAny("building options");
}

WorldModel generateBuilding(const Catalog& catalog, const BuildingOptions& options) {
  options.validate();
  return Building(catalog, options).generate();
}

}  // namespace casepush
