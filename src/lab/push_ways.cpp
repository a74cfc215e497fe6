#include "push_ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <vector>

#include "casepush/world/shadow.h"

namespace casepush {
namespace {

constexpr double kStep_m = 0.2;
constexpr double kObjectMargin_m = 0.02;
/// A push starts this far from the object, and nobody drives to where there is no play.
constexpr double kStartGap_m = 0.1;
constexpr double kRobotMargin_m = 0.05;
constexpr int kDirections = 8;
/// Turning takes pushes from several sides.
constexpr int kSidesToTurn = 5;

double angleOf(int direction) { return 2.0 * M_PI * direction / kDirections; }

}  // namespace

/// Best-first search over places on a grid about the start and headings in steps of 45 degrees.
class PushWaySearch {
 public:
  PushWaySearch(const PushWays& ways, const Pose2& start, const Pose2& goal)
      : ways_(ways), start_(start), goal_(goal) {
    for (int i = 0; i < kDirections; ++i) {
      reach_m_[static_cast<std::size_t>(i)] = ways.reach(angleOf(i));
    }
  }

  bool run() {
    add({0, 0, 0});
    while (!open_.empty()) {
      const Node node = open_.top().second;
      open_.pop();
      if (distance(poseOf(node), goal_) <= kStep_m) return true;
      int sides = 0;
      for (int direction = 0; direction < kDirections; ++direction) {
        if (!fitsBehind(node, direction)) continue;
        ++sides;
        const double angle = angleOf(direction);
        add({node[0] + static_cast<int>(std::lround(std::cos(angle))),
             node[1] + static_cast<int>(std::lround(std::sin(angle))), node[2]});
      }
      if (sides < kSidesToTurn) continue;
      add({node[0], node[1], (node[2] + 1) % kDirections});
      add({node[0], node[1], (node[2] + kDirections - 1) % kDirections});
    }
    return false;
  }

 private:
  using Node = std::array<int, 3>;  // Steps along the start's x and y; heading.
  using Entry = std::pair<double, Node>;

  Pose2 poseOf(const Node& node) const {
    return start_ * Pose2(kStep_m * node[0], kStep_m * node[1], angleOf(node[2]));
  }

  void add(const Node& node) {
    if (!seen_.insert(node).second) return;
    const Pose2 pose = poseOf(node);
    if (ways_.checker_.collides(*ways_.object_footprint_, pose)) return;
    open_.push({-distance(pose, goal_), node});
  }

  bool fitsBehind(const Node& node, int direction) const {
    const int in_object = (direction - node[2] + kDirections) % kDirections;
    const double reach_m = reach_m_[static_cast<std::size_t>(in_object)];
    const Pose2 pushing = start_ * Pose2(kStep_m * node[0], kStep_m * node[1], angleOf(direction));
    return !ways_.checker_.collides(*ways_.robot_footprint_, pushing * Pose2(-reach_m, 0.0, 0.0));
  }

  const PushWays& ways_;
  Pose2 start_;
  Pose2 goal_;
  std::array<double, kDirections> reach_m_{};
  std::set<Node> seen_;
  std::priority_queue<Entry> open_;
};

PushWays::PushWays(const CollisionChecker& checker, const ObjectModel& object,
                   const RobotModel& robot)
    : checker_(checker),
      object_(object),
      robot_(robot),
      object_footprint_(checker.footprint(object.solid, kObjectMargin_m)),
      robot_footprint_(checker.footprint(robot.solid, kRobotMargin_m)) {}

double PushWays::reach(double direction_rad) const {
  const Eigen::Vector2d backwards(-std::cos(direction_rad), -std::sin(direction_rad));
  double extent_m = 0.0;
  for (const PlacedShape& shape : object_.solid) {
    const ConvexPart part(shape);
    const Shadow& shadow = part.shadow();
    for (int i = 0; i < shadow.count; ++i) {
      extent_m = std::max(extent_m, shadow.points[i].dot(backwards) + shadow.radius_m);
    }
  }
  return extent_m + robot_.radius_m + kStartGap_m;
}

bool PushWays::lead(const Pose2& start, const Pose2& goal) const {
  return PushWaySearch(*this, start, goal).run();
}

}  // namespace casepush
