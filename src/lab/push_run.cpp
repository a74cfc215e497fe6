#include "casepush/lab/push_run.h"

#include <utility>

#include "task_lab.h"

namespace casepush {
namespace {

constexpr double kSettleS = 1.0;

}  // namespace

DirectPlanClient::DirectPlanClient(const PushPlanner& planner, CaseSource cases)
    : planner_(planner), cases_(std::move(cases)) {}

void DirectPlanClient::request(const PlanRequest& request) {
  result_ = planner_.plan(request, *cases_());
}

std::optional<PlanResult> DirectPlanClient::poll() { return std::exchange(result_, std::nullopt); }

void DirectPlanClient::cancel() { result_.reset(); }

PushRunResult runPushTask(const Catalog& catalog, const PushProblem& problem,
                          const std::vector<Case>& cases, std::shared_ptr<const Map> map,
                          const PushRunOptions& options,
                          const std::function<void(const PushTask&)>& watch) {
  TaskLab lab(catalog, problem.world, problem.object_id, cases, std::move(map), options);
  ClosedLoop& loop = lab.loop();
  PushTaskGoal goal;
  goal.object_id = problem.object_id;
  goal.map_T_goal = problem.map_T_goal;
  goal.time_limit_s = options.time_limit_s;
  goal.adapt = options.adapt;
  goal.clear_obstacles = options.clear_obstacles;
  goal.seed = options.lab.simulator.seed;
  PushTask task(goal, loop.simulator().robot(), lab.services(), options.task);
  loop.run(task, options.time_limit_s + kSettleS, [&] {
    if (watch) {
      watch(task);
    }
  });
  PushRunResult result;
  result.sim_time_s = loop.simulator().time();
  loop.idle(kSettleS);

  const Pose2 end = loop.simulator().trueObjectPose(problem.object_id);
  result.status = task.status();
  result.progress = task.progress();
  result.planning_s = lab.planningS();
  result.reports = lab.reports();
  result.noticed = lab.noticed();
  result.explanation = task.describe();
  result.position_error_m = distance(end, problem.map_T_goal);
  result.yaw_error_rad = std::abs(yawDifference(problem.map_T_goal, end));
  result.collisions = loop.collisions();
  result.collision_names = loop.collisionNames();
  result.success =
      task.status() == PushTaskStatus::kSucceeded && goal.tolerance.isMet(problem.map_T_goal, end);
  return result;
}

}  // namespace casepush
