#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/planning/clearing.h"

namespace casepush {

struct ClearWayOptions {
  ExecutePushOptions push;
  int max_pushes = 20;          ///< Of all obstacles together.
  int max_depth = 3;            ///< Of obstacles that are in the way of obstacles.
  double look_timeout_s = 5.0;  ///< Wait for an obstacle to come to rest.
  void validate() const;        ///< @throws InputError listing every violation.
};

/// What clearing needs from outside its own logic; all are required.
struct ClearWayServices {
  /// Ids of the movable objects that the plan's next push, or the robot's way to it, would hit.
  std::function<std::vector<std::string>(const PushPlan&, const Observation&)> blockers;
  /// The same for all pushes of a plan, among the given objects, without the robot's ways.
  std::function<std::vector<std::string>(const PushPlan&, const std::vector<PlacedObject>&)>
      in_the_way;
  std::function<ClearingResult(const ClearingRequest&)> clear;
  std::function<bool(const PlacedObject&)> is_movable;  ///< Are its cases known?
  std::function<std::vector<Case>(const std::string& model)> cases;
  std::function<ApproachPlanner(const std::string& object_id)> approach;
  std::function<void(const PushReport&)> on_report;  ///< Called once for each push.
};

/// All of them but on_report from a planner.
/// @param planner  Must outlive the result.
/// @param cases    Current cases of all objects; an object without cases of this robot is not
///   movable.
ClearWayServices clearWayServices(const PushPlanner& planner, const std::string& robot,
                                  std::function<std::vector<Case>()> cases);

/// Pushes movable obstacles out of the way of a plan's next push (paper section 4).
///
/// One obstacle after the other: it looks who is in the way, plans pushes that bring it out of the
/// way of the whole rest of the plan, and executes the first of them; then it looks again. If an
/// obstacle cannot be pushed away because others stand around it, those are cleared first, up to a
/// bounded depth. Succeeds once nothing is in the way; fails, naming the obstacle, if it cannot be
/// brought away.
class ClearWay : public Behaviour {
 public:
  /// @param way  Of the object to be pushed, from where it stands. @throws InputError from the
  ///   options.
  ClearWay(PushPlan way, RobotModel robot, ClearWayServices services, ClearWayOptions options);
  ~ClearWay() override;

  Tick tick(const Observation& observation) override;
  std::string describe() const override;
  void cancel();

  int pushes() const;                        ///< Executed.
  const std::string& stuckObstacle() const;  ///< Which one could not be cleared; "" if none.

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
