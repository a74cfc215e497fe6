#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/planning/clearing.h"

namespace casepush {

/// Gives the current cases of all objects; the same vector until one of them changes.
using CaseSource = std::function<std::shared_ptr<const std::vector<Case>>()>;

/// A search for the pushes of an obstacle that goes on elsewhere. Asked for its result again and
/// again until there is one; whoever drops it gives it up.
using PendingClearing = std::function<std::optional<ClearingResult>()>;

/// Begins a search.
using BeginClearing = std::function<PendingClearing(const ClearingRequest&)>;

/// Searches in the caller's thread: the result is there at once.
BeginClearing searchAtOnce(std::function<ClearingResult(const ClearingRequest&)> search);

struct ClearWayOptions {
  ExecutePushOptions push;
  int max_pushes = 20;  ///< Of all obstacles together.
  int max_depth = 3;    ///< Of obstacles that are in the way of obstacles.
  /// Pushes that must be clear before the next one is made. In front of an obstacle there may be no
  /// room left to push it, so it is cleared from some way off.
  int pushes_ahead = 3;
  double deadline_s = 2.0;      ///< Wall time to look for the pushes of one obstacle.
  double look_timeout_s = 5.0;  ///< Wait for an obstacle to come to rest.
  void validate() const;        ///< @throws InputError listing every violation.
};

/// What clearing needs from outside its own logic; all are required.
struct ClearWayServices {
  /// Ids of the movable objects that so many of the plan's next pushes, or the robot's way to the
  /// first of them, would hit.
  std::function<std::vector<std::string>(const PushPlan&, const Observation&, int pushes)> blockers;
  BeginClearing clear;
  /// The rest of an obstacle's plan from where it came to rest; nothing if its next push would
  /// collide.
  std::function<std::optional<PushPlan>(const PushPlan& rest, const Observation&)> go_on;
  std::function<bool(const PlacedObject&)> is_movable;  ///< Are its cases known?
  std::function<std::vector<Case>(const std::string& model)> cases;
  std::function<ApproachPlanner(const std::string& object_id)> approach;
  std::function<TouchCheck(const std::string& object_id)> touches;
  std::function<void(const PushReport&)> on_report;  ///< Called once for each push.
};

/// All of them but on_report from a planner, which is asked for anew each time; it searches at
/// once.
/// @param cases  An object without cases of this robot is not movable.
ClearWayServices clearWayServices(const PlannerSource& planner, const std::string& robot,
                                  const CaseSource& cases);

/// Pushes movable obstacles out of the way of a plan's next pushes (paper section 4).
///
/// One obstacle after the other: it looks who is in the way, plans pushes that bring it out of the
/// way of the whole rest of the plan, or where there is no room for that of the next pushes, and
/// executes them, anew from where the obstacle comes to rest if it is elsewhere than expected; then
/// it looks again. On the same trip it clears what the rest of the plan will hit farther on, if
/// that is less of a way now than there and back later. If an obstacle cannot be pushed away
/// because others stand around it, those are cleared first, up to a bounded depth. Succeeds once
/// nothing is in the way; fails, naming the obstacle, if it cannot be brought away.
class ClearWay : public Behaviour {
 public:
  /// @param way  Of the object to be pushed, from where it stands. @throws InputError from the
  ///   options.
  ClearWay(PushPlan way, RobotModel robot, ClearWayServices services, ClearWayOptions options);
  ~ClearWay() override;

  /// Is anything in the way at all? The first tick does not look again.
  bool isNeeded(const Observation& observation);

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
