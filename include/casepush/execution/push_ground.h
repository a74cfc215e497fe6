#pragma once

#include <optional>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/object_model.h"
#include "casepush/model/robot_model.h"
#include "casepush/planning/clearance_field.h"

namespace casepush {

/// The course of a push that was or may be made, in the frame of the object's resting pose.
struct PushCourse {
  std::vector<Pose2> start_T_object;
  std::vector<Pose2> start_T_robot;
  PoseGaussian start_outcome;
};
PushCourse courseOf(const Case& push_case);

/// Free floor on which a robot that drives can push an object again and again.
///
/// It must never get the object to where it can not get behind it any more, so pushes should end
/// where the robot fits between the object and whatever stands nearest, on all sides. Object and
/// robot count as discs here. Thread safety: const methods are reentrant.
class PushGround {
 public:
  /// @param checker     With everything else that stands around as obstacles.
  /// @param map_start_m Where the object stands: the ground is what can be reached from there.
  PushGround(const CollisionChecker& checker, const ObjectModel& object, const RobotModel& robot,
             const Eigen::Vector2d& map_start_m);

  /// Free width around a pose of the object [m]; negative: it overlaps something.
  double objectRoom(const Pose2& map_T_object) const;
  double robotRoom(const Pose2& map_T_robot) const;

  /// Room in which the robot gets around the object.
  double neededRoomM() const { return needed_m_; }
  /// A place with plenty of room on all sides, or the one with most, as near as may be.
  const Eigen::Vector2d& middle() const { return middle_m_; }

  /// Room around the object after a push, two standard deviations to the worse [m]; nothing if
  /// object or robot come too near to something on the way.
  std::optional<double> roomAfter(const Pose2& map_T_object, const PushCourse& course) const;

  /// True if nothing but the robot has touched the object and the robot had its way: else an
  /// outcome tells about the walls, not about the push.
  bool wasFree(const Pose2& map_T_start, const PushCourse& course) const;

 private:
  bool isFree(const Pose2& map_T_start, const PushCourse& course, double object_margin_m,
              double robot_margin_m) const;
  Eigen::Vector2d findMiddle(const Eigen::Vector2d& start_m) const;

  ClearanceField clearance_;
  double object_radius_m_;
  double robot_radius_m_;
  double needed_m_;
  Eigen::Vector2d middle_m_;
};

}  // namespace casepush
