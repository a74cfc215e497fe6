#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/model/push_plan.h"

namespace casepush {

enum class PushTaskStatus {
  kRunning,
  kSucceeded,
  kCancelled,
  kInvalidGoal,  ///< As PlanStatus: invalid request, no cases, goal in collision or off the map.
  kNoPlan,       ///< Planning failed too often.
  kPlannerGone,
  kObjectLost,
  kRobotLost,
  kNoProgress,  ///< Too many pushes or re-plans.
  kTimeout,
};
const char* toString(PushTaskStatus status);

struct PushTaskGoal {
  std::string object_id;
  Pose2 map_T_goal;
  GoalTolerance tolerance;
  double time_limit_s = 900.0;  ///< Simulated or real seconds, by the observations' stamps.
  bool adapt = true;            ///< Let the pushes of this task adapt the cases.
  std::uint64_t seed = 1;
};

struct PushTaskOptions {
  ExecutePushOptions push;
  int max_replans = 60;
  int max_pushes = 200;
  int max_failed_plans = 5;             ///< In a row, with different seeds; likewise approaches.
  int max_plans_without_progress = 25;  ///< Plans in a row, none shorter than the best before.
  double plan_deadline_s = 10.0;        ///< Wall time for one plan.
  double look_timeout_s = 10.0;         ///< Wait for the object to be seen at rest.
  double goal_share = 0.9;              ///< Of the goal's tolerance, that plans aim at.
  double goal_margin_m = 0.01;       ///< Least distance of the observed pose from the tolerance's
  double goal_margin_rad = 0.01745;  ///< bounds; more if its covariance says so (2 sigma).
  void validate() const;             ///< @throws InputError listing every violation.
};

/// Numbers of a task, kept up to date while it runs.
struct PushTaskProgress {
  std::string phase;   ///< "look", "planning", "approach", "dock", "push", "rest" or "done".
  int push_index = 0;  ///< Of the current plan, from 1.
  int push_count = 0;  ///< Of the current plan.
  int pushes = 0;      ///< Executed in all.
  int plans = 0;
  int replans = 0;
  int rejected_predictions = 0;
  double plan_length_m = 0.0;  ///< Of the first plan.
  double distance_to_goal_m = 0.0;
  double yaw_to_goal_rad = 0.0;
};

/// Whatever a push task needs from outside its own logic. Only `plans`, `cases` and either
/// `checker` or both functions below it are required.
struct PushTaskServices {
  using ContinuePlan = std::function<PushPlanner::Continuation(
      const PushPlan& rest, const Pose2& map_T_object, const std::vector<Case>& cases,
      const std::vector<PlacedObject>& obstacles)>;

  PlanClient* plans = nullptr;           ///< Must outlive the task.
  const PushPlanner* checker = nullptr;  ///< For continue_plan and approach, unless they are given;
                                         ///< must outlive the task.
  ContinuePlan continue_plan;  ///< To be given if the planner may be replaced, e.g. by a new map.
  ApproachPlanner approach;
  std::function<std::vector<Case>()> cases;          ///< Current cases of the object.
  std::function<void(const PushReport&)> on_report;  ///< Called once for each push.
  std::function<void(const PlanResult&)> on_plan;    ///< Called once for each plan, also failed.
};

/// Brings one object to a goal: plan, approach, push, wait, test, go on or re-plan (paper 3.3).
///
/// Looks until the object is seen at rest, asks for a plan, and executes it push by push. After
/// each push it goes on with the plan, re-anchored at the observed pose, unless the prediction was
/// rejected or the rest does not lead to the goal safely any more; then it plans anew. It has
/// succeeded once the object rests within the tolerance by some margin. Where no plan for that is
/// found, the bare tolerance is enough.
///
/// The task itself changes no case: whoever receives the reports adapts them if the goal says so.
class PushTask : public Behaviour {
 public:
  /// @throws InputError from the options, or if a required service is missing.
  PushTask(PushTaskGoal goal, RobotModel robot, PushTaskServices services, PushTaskOptions options);
  ~PushTask() override;

  Tick tick(const Observation& observation) override;
  std::string describe() const override;
  void cancel();

  PushTaskStatus status() const;

  /// The plan being executed, re-anchored at the latest observed pose; nothing before the first
  /// one.
  const std::optional<PushPlan>& plan() const;
  const PushTaskProgress& progress() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
