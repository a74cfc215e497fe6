#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/model/push_plan.h"

namespace casepush {

enum class PushTaskStatus {
  kRunning,
  kSucceeded,
  kCancelled,
  kInvalidGoal,     ///< As PlanStatus: invalid request, no cases, goal in collision or off the map.
  kNoPlan,          ///< Planning failed too often.
  kPlannerGone,
  kObjectLost,
  kRobotLost,
  kNoProgress,      ///< Too many pushes or re-plans.
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
  int max_failed_plans = 5;      ///< In a row, with different seeds.
  double plan_deadline_s = 10.0;
  double look_timeout_s = 10.0;  ///< Wait at the start for the object to be seen.
  void validate() const;         ///< @throws InputError listing every violation.
};

/// Numbers of a task, kept up to date while it runs.
struct PushTaskProgress {
  std::string phase;           ///< "planning", "approach", "push", "rest", ...
  int push_index = 0;          ///< Of the current plan, from 1.
  int push_count = 0;          ///< Of the current plan.
  int pushes = 0;              ///< Executed in all.
  int plans = 0;
  int replans = 0;
  int rejected_predictions = 0;
  double plan_length_m = 0.0;  ///< Of the first plan.
  double distance_to_goal_m = 0.0;
  double yaw_to_goal_rad = 0.0;
};

/// Whatever a push task needs from outside its own logic.
struct PushTaskServices {
  PlanClient* plans = nullptr;         ///< Must outlive the task.
  const PushPlanner* checker = nullptr;  ///< For continuePlan and approachPath; may be re-set.
  std::function<std::vector<Case>()> cases;  ///< Current cases of the object.
  std::function<void(const PushReport&)> on_report;  ///< Called once for each push.
  std::function<void(const PlanResult&)> on_plan;    ///< Called once for each plan, also failed.
};

/// Brings one object to a goal: plan, approach, push, wait, test, go on or re-plan (paper 3.3).
class PushTask : public Behaviour {
 public:
  PushTask(PushTaskGoal goal, RobotModel robot, PushTaskServices services, PushTaskOptions options);
  ~PushTask() override;

  Tick tick(const Observation& observation) override;
  std::string describe() const override;
  void cancel();

  PushTaskStatus status() const;
  const PushTaskProgress& progress() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
