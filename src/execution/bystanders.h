#pragma once

#include <string>
#include <vector>

#include "casepush/model/observation.h"
#include "casepush/model/push_plan.h"

namespace casepush {

/// Is an object where it is known to be? Some centimetres are the scatter of estimates.
bool isAmong(const std::vector<PlacedObject>& known, const PlacedObject& object);

/// Watches the other objects beside a path that the robot drives.
class Bystanders {
 public:
  /// @param waypoints  Of a path that minds all that stand around now, but the object `but_id`.
  void note(const Observation& observation, const std::string& but_id,
            std::vector<Pose2> waypoints);

  /// Has one come in sight, or moved, so near to the path that it may be in the way?
  bool haveChanged(const Observation& observation) const;

 private:
  bool isNear(const Pose2& map_T_object) const;

  std::string but_id_;
  std::vector<Pose2> waypoints_;
  std::vector<PlacedObject> known_;
};

}  // namespace casepush
