#include "casepush/lab/room_generator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "room_builder.h"

namespace casepush {
namespace {

/// Between furniture and what must stay free.
constexpr double kGap_m = 0.2;
/// The least play that start, bend and goal have, each in x and y.
constexpr double kLeastSpan_m = 2.2;
constexpr int kWayDraws = 1000;
constexpr double kDegree = M_PI / 180.0;

/// Start, bend and goal.
struct Way {
  std::array<Eigen::Vector2d, 3> points;
};

class RoomGenerator {
 public:
  RoomGenerator(const Catalog& catalog, const RoomOptions& options)
      : catalog_(catalog),
        options_(options),
        object_(catalog.object(options.object)),
        robot_(catalog.robot(options.robot)),
        random_(Random::stream(options.seed, "room")),
        builder_("room_" + std::to_string(options.seed), options.size_m, &random_),
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
    builder_.world().robot = options_.robot;
    placeBodies(drawWay());
    placeMovable();
    furnish();
    return std::move(builder_.world());
  }

 private:
  static std::string describe(double value) {
    std::ostringstream text;
    text.precision(3);
    text << value;
    return text.str();
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

  void placeBodies(const Way& way) {
    const Eigen::Vector2d start = way.points[0];
    const Eigen::Vector2d goal = way.points[2];
    WorldModel& world = builder_.world();
    world.objects.push_back(
        {"object_1", options_.object, Pose2(start.x(), start.y(), drawHeading(random_, 1.0)), 0});
    world.goal = Pose2(goal.x(), goal.y(), drawHeading(random_, 1.0));
    const Eigen::Vector2d ahead = (way.points[1] - start).normalized();
    const Eigen::Vector2d robot =
        start - (object_.radius_m + robot_.radius_m + 0.5 * kGap_m) * ahead;
    world.map_T_robot = Pose2(robot.x(), robot.y(),
                              std::round(std::atan2(ahead.y(), ahead.x()) / kDegree) * kDegree);
    for (const Eigen::Vector2d& point : way.points) builder_.keepFree(point, around_m_);
    const double passing_m = std::max(object_.radius_m, robot_.radius_m) + kGap_m;
    for (int leg = 0; leg < 2; ++leg) {
      builder_.keepLegFree(way.points[leg], way.points[leg + 1], passing_m);
    }
  }

  void placeMovable() {
    int number = 0;
    for (const std::string& object : options_.movable) {
      ++number;
      if (!builder_.placeObject("movable_" + std::to_string(number), catalog_.object(object),
                                number * kTagsPerObject)) {
        throw InputError("movable objects", object + " finds no place in " +
                                                describe(options_.size_m) +
                                                " m; ask for fewer or for a larger room");
      }
    }
  }

  void furnish() {
    const double reached = builder_.furnish(options_.density);
    if (reached < options_.density) {
      throw InputError("room density",
                       describe(options_.density) + " does not fit: " + describe(reached) +
                           " was reached beside the way of the " + object_.name + " in " +
                           describe(options_.size_m) + " m; ask for less or for a larger room");
    }
  }

  const Catalog& catalog_;
  const RoomOptions& options_;
  ObjectModel object_;
  RobotModel robot_;
  Random random_;
  RoomBuilder builder_;
  double around_m_;
  double margin_m_;
  double span_m_;
};

}  // namespace

void RoomOptions::validate() const {
  Violations violations;
  violations.require("size", size_m, 2.0, 100.0);
  violations.require("density", density, 0.0, 0.5);
  violations.require("number of movable objects", static_cast<double>(movable.size()), 0, 5);
  violations.throwIfAny("room options");
}

WorldModel generateRoom(const Catalog& catalog, const RoomOptions& options) {
  options.validate();
  return RoomGenerator(catalog, options).generate();
}

}  // namespace casepush
