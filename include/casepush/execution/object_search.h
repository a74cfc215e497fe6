#pragma once

#include <memory>
#include <string>

#include "casepush/execution/behaviour.h"
#include "casepush/execution/execute_push.h"
#include "casepush/model/robot_model.h"

namespace casepush {

struct ObjectSearchOptions {
  double wait_s = 1.0;         ///< Standing, before anything else: what hides it may go away.
  double look_s = 0.6;         ///< Standing, at each place from where to look.
  double near_m = 1.5;         ///< Radii of the two rings of places to look from, around
  double far_m = 3.0;          ///< where the object was last seen.
  double speed_mps = 0.4;      ///< On the way.
  double time_limit_s = 90.0;  ///< For all of it.
  void validate() const;       ///< @throws InputError listing every violation.
};

/// Looks for an object that is out of sight.
///
/// The robot stands for a while, turns a camera towards where the object was last seen, and then
/// drives to places around that spot, the nearest one first, until the object is seen. It has
/// failed when there is no place left, or after the time limit. The cameras' fields of view come
/// from the robot's model; a robot without cameras looks straight ahead. What hides the view of a
/// place is not known beforehand: from six sides at two distances hardly anything does.
///
/// The way to a place counts the object as standing where it was last seen. A place that can not be
/// reached, or on the way to which something holds the robot, is left out.
class ObjectSearch : public Behaviour {
 public:
  /// @param last_seen  The object; a state with a newer stamp ends the search.
  /// @param way  Called with observations that contain the object.
  /// @throws InputError from the options.
  ObjectSearch(ObjectState last_seen, RobotModel robot, ApproachPlanner way,
               ObjectSearchOptions options);
  ~ObjectSearch() override;
  ObjectSearch(ObjectSearch&&) noexcept;
  ObjectSearch& operator=(ObjectSearch&&) noexcept;

  Tick tick(const Observation& observation) override;
  std::string describe() const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// The heading, nearest to the robot's own, at which a camera of it shows `target_position` [m]
/// from where it stands, well within its field of view.
double viewingYaw(const RobotModel& robot, const Pose2& map_T_robot,
                  const Eigen::Vector2d& target_position);

}  // namespace casepush
