#include "casepush/planning/push_checker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace casepush {
namespace {

constexpr double kToleranceRange_m = 0.3;

}  // namespace

const char* toString(PushConflict conflict) {
  switch (conflict) {
    case PushConflict::kNone:
      return "none";
    case PushConflict::kOutcome:
      return "the object may come to rest in a collision";
    case PushConflict::kObjectMotion:
      return "the object would collide on its way";
    case PushConflict::kRobotMotion:
      return "the robot would collide on its way";
  }
  return "unknown";
}

PushChecker::PushChecker(CollisionChecker checker, Body object, Body robot)
    : checker_(std::move(checker)), object_(std::move(object)), robot_(std::move(robot)) {}

PushChecker::PushChecker(SweepChecker sweeps, Body object, Body robot)
    : checker_(sweeps.collisions()),
      sweeps_(std::move(sweeps)),
      object_(std::move(object)),
      robot_(std::move(robot)) {}

const ClearanceField& PushChecker::clearance() {
  if (!clearance_) clearance_.emplace(checker_.columns());
  return *clearance_;
}

bool PushChecker::isObjectFarFromAll(const Eigen::Vector2d& position_m, double deviation_m) {
  return clearance().at(position_m) >= object_.radius_m + deviation_m;
}

bool PushChecker::isRobotFarFromAll(const Eigen::Vector2d& position_m, double deviation_m) {
  return clearance().at(position_m) >= robot_.radius_m + deviation_m;
}

void PushChecker::tolerateStart(const Pose2& map_T_start) {
  tolerated_start_ = map_T_start;
  tolerated_depth_m_ = 0.0;
  for (const Contact& contact : checker_.contacts(*object_.footprint, map_T_start)) {
    tolerated_depth_m_ = std::max(tolerated_depth_m_, contact.depth_m);
  }
}

double PushChecker::lenientRange() const {
  return tolerated_depth_m_ > 0.0 ? kToleranceRange_m : 0.0;
}

bool PushChecker::isFree(const Pose2& map_T_object) {
  return !collides(object_, map_T_object) || isTolerated(map_T_object);
}

bool PushChecker::isTolerated(const Pose2& map_T_object) const {
  constexpr double kSlack_m = 1e-3;
  if (tolerated_depth_m_ <= 0.0 || distance(map_T_object, tolerated_start_) > kToleranceRange_m) {
    return false;
  }
  const std::vector<Contact> contacts = checker_.contacts(*object_.footprint, map_T_object);
  return std::all_of(contacts.begin(), contacts.end(), [this](const Contact& contact) {
    return contact.depth_m <= tolerated_depth_m_ + kSlack_m;
  });
}

bool PushChecker::collides(const Body& body, const Pose2& map_T_x) {
  ++check_count_;
  return checker_.collides(*body.footprint, map_T_x);
}

bool PushChecker::anyCollides(const Body& body, const Pose2& map_T_start,
                              const std::vector<Pose2>& start_T_x) {
  const double cosine = std::cos(map_T_start.yaw());
  const double sine = std::sin(map_T_start.yaw());
  const ClearanceField& clear = clearance();
  for (const Pose2& pose : start_T_x) {
    ++check_count_;
    // In the open the position alone decides, without the trigonometry of a product of poses.
    const Eigen::Vector2d position(map_T_start.x() + cosine * pose.x() - sine * pose.y(),
                                   map_T_start.y() + sine * pose.x() + cosine * pose.y());
    if (clear.at(position) < body.radius_m &&
        checker_.collides(*body.footprint, map_T_start * pose)) {
      return true;
    }
  }
  return false;
}

bool PushChecker::objectCollidesOnItsWay(const PreparedCase& push_case, const Pose2& map_T_start) {
  if (!anyCollides(object_, map_T_start, push_case.start_T_object)) {
    return false;
  }
  return tolerated_depth_m_ <= 0.0 ||
         std::any_of(push_case.start_T_object.begin(), push_case.start_T_object.end(),
                     [&](const Pose2& pose) { return !isFree(map_T_start * pose); });
}

bool PushChecker::isSafe(const PreparedCase& push_case, const Pose2& map_T_object) {
  if (!sweeps_ || !push_case.sweep) {
    return conflict(push_case, map_T_object) == PushConflict::kNone;
  }
  ++check_count_;
  if (!sweeps_->collides(*push_case.sweep, map_T_object)) return true;
  return mayBeTolerated(*push_case.sweep, map_T_object) &&
         conflict(push_case, map_T_object) == PushConflict::kNone;
}

// Only near the tolerated start may a motion overlap anything.
bool PushChecker::mayBeTolerated(const Sweep& sweep, const Pose2& map_T_object) const {
  return tolerated_depth_m_ > 0.0 &&
         distance(map_T_object, tolerated_start_) <= sweep.reach() + kToleranceRange_m;
}

bool PushChecker::mayCollide(const PreparedCase& push_case, const Pose2& map_T_object) {
  if (!sweeps_ || !push_case.sweep || mayBeTolerated(*push_case.sweep, map_T_object)) {
    return !isSafe(push_case, map_T_object);
  }
  ++check_count_;
  return sweeps_->mayCollide(*push_case.sweep, map_T_object);
}

PushConflict PushChecker::conflict(const PreparedCase& push_case, const Pose2& map_T_object) {
  if (collides(object_, map_T_object * push_case.start_outcome.mean) ||
      anyCollides(object_, map_T_object, push_case.start_T_sigma)) {
    return PushConflict::kOutcome;
  }
  if (anyCollides(robot_, map_T_object, push_case.start_T_robot)) {
    return PushConflict::kRobotMotion;
  }
  if (objectCollidesOnItsWay(push_case, map_T_object)) {
    return PushConflict::kObjectMotion;
  }
  return PushConflict::kNone;
}

}  // namespace casepush
