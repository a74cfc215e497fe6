#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/clear_way.h"
#include "casepush/execution/execute_push.h"
#include "casepush/execution/object_search.h"
#include "casepush/execution/replan_cause.h"
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
  double time_limit_s = 900.0;   ///< Simulated or real seconds, by the observations' stamps.
  bool adapt = true;             ///< Let the pushes of this task adapt the cases.
  bool clear_obstacles = false;  ///< Push other objects out of the way where that is quicker.
  std::uint64_t seed = 1;
};

/// When the rest of a plan, begun where the last push really ended, is given up.
enum class RestRule {
  kMeanAtGoal,  ///< As soon as its mean ends beside the goal.
  kLikelyEnd,   ///< As soon as it ends at the goal much less probably than a rest that aims right.
};
const char* toString(RestRule rule);

struct RestOptions {
  RestRule rule = RestRule::kLikelyEnd;
  /// kLikelyEnd: least probability of ending at the goal, as a share of what it would be if the
  /// same pushes aimed at the goal's centre. Far from the goal pushes scatter more than they miss;
  /// for the last one or two the rule is strict.
  double least_share = 0.01;
  /// Pushes ahead that must be free of collisions. Those further ahead start where nobody knows yet
  /// within centimetres; they are looked at again after each push.
  int horizon = 1;
  /// Give the plan up after each rejected prediction (paper section 3.3), also if the rest, with
  /// the case as adapted by then, still leads to the goal.
  bool replan_when_rejected = false;
  /// Where only the end misses, keep the next push, and while it is made plan anew what follows it.
  bool repair = true;
};

struct PushTaskOptions {
  ExecutePushOptions push;
  ClearWayOptions clear;
  bool break_off = true;  ///< Switches push.tube on.
  ObjectSearchOptions search;
  RestOptions rest;
  int max_replans = 60;
  int max_pushes = 200;
  int max_failed_plans = 5;             ///< In a row, with different seeds; likewise approaches.
  int max_idle_pushes = 5;              ///< In a row that did not move the object.
  int max_plans_without_progress = 25;  ///< Plans in a row, none shorter than the best before.
  double plan_deadline_s = 10.0;        ///< Wall time for one plan.
  double look_timeout_s = 10.0;         ///< Wait for the object to be seen at rest.
  int max_searches = 5;                 ///< For an object that went out of sight, in all.
  double goal_share = 0.9;              ///< Of the goal's tolerance, that plans aim at.
  double goal_margin_m = 0.01;       ///< Least distance of the observed pose from the tolerance's
  double goal_margin_rad = 0.01745;  ///< bounds; more if its covariance says so (2 sigma).
  void validate() const;             ///< @throws InputError listing every violation.
};

/// Numbers of a task, kept up to date while it runs.
struct PushTaskProgress {
  /// "look", "search", "planning", "approach", "dock", "push", "rest" or "done".
  std::string phase;
  int push_index = 0;       ///< Of the current plan, from 1.
  int push_count = 0;       ///< Of the current plan.
  int pushes = 0;           ///< Executed in all, but for those of obstacles.
  int clearing_pushes = 0;  ///< That brought other objects out of the way.
  int idle_pushes = 0;      ///< The last ones, in a row, that did not move the object.
  int plans = 0;
  int replans = 0;  ///< Plans whose rest was given up for another plan.
  int repairs = 0;  ///< Plans that were kept but for what followed the next push; no re-plans.
  ReplanCounts replan_causes;
  std::vector<ReplanCause> replan_history;  ///< The same in order, one for each re-plan.
  std::vector<std::string> replan_reasons;  ///< In words, one for each re-plan.
  /// Pushes made with each plan: all but the last plan were given up then. Plans of which no push
  /// was made count with 0, repaired ones as one plan.
  std::vector<int> pushes_per_plan;
  std::vector<int> pushes_unchanged;  ///< Likewise, but a repaired plan counts as another plan.
  int rejected_predictions = 0;
  double plan_length_m = 0.0;  ///< Of the first plan.
  double distance_to_goal_m = 0.0;
  double yaw_to_goal_rad = 0.0;

  void beginPlan() {
    pushes_per_plan.push_back(0);
    pushes_unchanged.push_back(0);
  }
};

/// Whatever a push task needs from outside its own logic. Only `plans`, `cases` and either
/// `checker` or both functions below it are required.
struct PushTaskServices {
  using ContinuePlan = std::function<PushPlanner::Continuation(
      const PushPlan& rest, const Pose2& map_T_object, const std::vector<Case>& cases,
      const std::vector<PlacedObject>& obstacles)>;

  using InTheWay = std::function<std::vector<std::string>(
      const PushPlan& plan, const std::vector<PlacedObject>& objects)>;

  PlanClient* plans = nullptr;           ///< Must outlive the task.
  const PushPlanner* checker = nullptr;  ///< For continue_plan and approach, unless they are given;
                                         ///< must outlive the task.
  ContinuePlan continue_plan;  ///< To be given if the planner may be replaced, e.g. by a new map.
  ApproachPlanner approach;
  TouchCheck touches;   ///< What stops a push; by the checker if it is not given, and without one
                        ///< nothing does.
  InTheWay in_the_way;  ///< Ids of the objects that any push of a plan hits; by the checker if it
                        ///< is not given, and without one nobody.
  CaseSource cases;     ///< Current cases of all objects.
  /// What pushing others out of the way takes; absent: they stand still. on_report is that below.
  std::optional<ClearWayServices> clearing;
  std::function<void(const PushReport&)> on_report;  ///< Called once for each push.
  std::function<void(const PlanResult&)> on_plan;    ///< Called once for each plan, also failed.
};

/// Brings one object to a goal: plan, approach, push, wait, test, go on or re-plan (paper 3.3).
///
/// Looks until the object is seen at rest, asks for a plan, and executes it push by push. An object
/// that was seen before and is out of sight is searched (ObjectSearch). After
/// each push it goes on with the plan, re-anchored at the observed pose and with the cases as
/// adapted by then, unless its next pushes would collide, an object in the way came in sight since,
/// or it would end too far from the goal (RestOptions); then it plans anew. A push whose object
/// leaves its expected course is broken off. The task has succeeded once the object rests within
/// the tolerance by some margin. Where no plan for that is found, the bare tolerance is enough.
/// docs/execution.md says why.
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
