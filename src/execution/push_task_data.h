#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "casepush/execution/push_task.h"
#include "clearing_estimate.h"
#include "rest_of_plan.h"
#include "watches.h"

namespace casepush {

/// What PushTask is made of: the stages are in push_task.cpp, what happens to a plan's pushes in
/// push_task_pushes.cpp.
struct PushTask::Data {
  enum class Stage { kLook, kSearch, kPlan, kClear, kPush, kDone };

  Data(PushTaskGoal push_goal, RobotModel robot_model, PushTaskServices outside,
       const PushTaskOptions& task_options);

  PushTaskGoal goal;
  RobotModel robot;
  PushTaskServices services;
  PushTaskOptions options;
  RobotWatch robot_watch;
  RestWatch rest;
  TickClock clock;

  Stage stage = Stage::kLook;
  PushTaskStatus status = PushTaskStatus::kRunning;
  PushTaskProgress progress;
  std::string text = "looking for the object";
  bool cancelled = false;
  std::optional<double> began_s;
  double stage_began_s = 0.0;
  std::optional<PushPlan> plan;  ///< Its first push is the next one.
  PlanRequest request;
  std::vector<PlacedObject> known;  ///< All others that the plan was last compared with.
  std::optional<ExecutePush> push;
  std::optional<PlanResult> through;  ///< A plan through movable objects, while one around is made,
  std::optional<PlanResult> around;   ///< and that, while it is estimated what clearing takes.
  std::optional<ClearingEstimate> estimate;
  std::optional<ClearWay> clear;
  std::set<std::string> immovable;  ///< What could not be cleared away.
  std::optional<ObjectState> last_seen;
  std::optional<ObjectSearch> search;
  int searches = 0;
  int failed_plans = 0;
  int failed_approaches = 0;
  int plans_without_progress = 0;
  bool is_repairing = false;   ///< A plan for what comes after the present push is being made.
  bool repair_failed = false;  ///< The last one was.
  int accepted_dead_end = 0;   ///< Push of the plan (from 1) that no other plan could do without.
  double shortest_plan_m = std::numeric_limits<double>::infinity();

  Tick run(const Observation& observation);
  Tick step(const Observation& observation);
  Tick look(const Observation& observation);
  Tick searchOn(const Observation& observation);
  Tick awaitPlan(const Observation& observation);
  Tick pushOn(const Observation& observation);
  Tick clearOn(const Observation& observation);
  bool isMovable(const PlacedObject& object) const;
  std::vector<PlacedObject> obstacles(const Observation& observation) const;
  std::string newcomerInTheWay(const PushPlan& rest_of_plan, const Observation& observation);
  bool asksForWayAround(const PlanResult& result, const Observation& observation);
  std::optional<PlanResult> quicker();
  Tick take(const PlanResult& chosen, const Observation& observation);
  void estimateClearing(const Observation& observation);
  bool beginClearing(const Observation& observation);
  void enter(Stage next, const char* phase, const std::string& what, double now_s);
  void end(PushTaskStatus final_status, const std::string& why);
  void requestPlan(const Observation& observation, const ObjectState& object);
  void acceptPlan(const PlanResult& result, const Observation& observation);
  void rejectPlan(const PlanResult& result, const Observation& observation);
  bool isLimitReached();
  void startPush(const Observation& observation);
  void concludePush(const PushReport& report, const Observation& observation);
  bool endAtGoal(const Observation& observation);
  void judgeOutcome(const PushReport& report, const Observation& observation);
  void goOn(const PushReport& report, const ObjectState& object, const Observation& observation);
  bool beginRepair(const RestVerdict& verdict, const PushPlan& rest_of_plan,
                   const Observation& observation);
  void endRepair();
  void dropRepair();
  void cancelPlanning();
  void notePlan(const PlanResult& made);
  void replan(ReplanCause cause, const std::string& why, const Observation& observation);
  void measure(const Observation& observation);
};

}  // namespace casepush
