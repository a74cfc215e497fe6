#include "bystanders.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "casepush/execution/execute_push.h"

namespace casepush {
namespace {

// More than this is no scatter of an estimate: it was moved.
constexpr double kMovedM = 0.1;
constexpr double kMovedRad = 0.2;
// Beyond this the largest furniture does not reach a robot on the path.
constexpr double kNearM = 1.8;

}  // namespace

bool isAmong(const std::vector<PlacedObject>& known, const PlacedObject& object) {
  return std::any_of(known.begin(), known.end(), [&object](const PlacedObject& each) {
    return each.id == object.id && distance(each.map_T_object, object.map_T_object) <= kMovedM &&
           std::abs(yawDifference(each.map_T_object, object.map_T_object)) <= kMovedRad;
  });
}

void Bystanders::note(const Observation& observation, const std::string& but_id,
                      std::vector<Pose2> waypoints) {
  but_id_ = but_id;
  waypoints_ = std::move(waypoints);
  known_ = otherObjects(observation, but_id);
}

bool Bystanders::haveChanged(const Observation& observation) const {
  const std::vector<PlacedObject> others = otherObjects(observation, but_id_);
  return std::any_of(others.begin(), others.end(), [this](const PlacedObject& each) {
    return !isAmong(known_, each) && isNear(each.map_T_object);
  });
}

bool Bystanders::isNear(const Pose2& map_T_object) const {
  const Eigen::Vector2d place = map_T_object.position();
  for (std::size_t i = 1; i < waypoints_.size(); ++i) {
    const Eigen::Vector2d from = waypoints_[i - 1].position();
    const Eigen::Vector2d leg = waypoints_[i].position() - from;
    const double share =
        std::clamp(leg.dot(place - from) / std::max(leg.squaredNorm(), 1e-12), 0.0, 1.0);
    if ((from + share * leg - place).norm() < kNearM) return true;
  }
  return false;
}

}  // namespace casepush
