#pragma once

#include <memory>

#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"
#include "casepush/world/collision_checker.h"

namespace casepush {

/// Whether an object can be pushed from one place to another by a robot that must stand behind it.
///
/// Optimistic about motion: a push moves the object straight ahead in one of eight directions, or
/// turns it in place. Strict about room: the object must be free wherever it goes, the robot must
/// fit behind it at the start of each push, and at most sides of it for a turn. So an object in a
/// corner has no way out.
class PushWays {
 public:
  /// @pre All outlive this. @param checker  With all other objects as obstacles.
  PushWays(const CollisionChecker& checker, const ObjectModel& object, const RobotModel& robot);

  bool lead(const Pose2& start, const Pose2& goal) const;

 private:
  friend class PushWaySearch;

  /// From the object's origin to that of the robot, which will push along `direction_rad` of the
  /// object's frame.
  double reach(double direction_rad) const;

  const CollisionChecker& checker_;
  const ObjectModel& object_;
  const RobotModel& robot_;
  std::shared_ptr<const Footprint> object_footprint_;
  std::shared_ptr<const Footprint> robot_footprint_;
};

}  // namespace casepush
