#include "casepush/lab/push_run.h"

#include <utility>

#include "casepush/cases/shortened_case.h"

namespace casepush {
namespace {

constexpr double kSettleS = 1.0;

/// Cases in memory that the pushes of one task adapt.
class WorkingCases {
 public:
  WorkingCases(const std::vector<Case>& cases, const std::string& object,
               const PushRunOptions& options)
      : adapt_(options.adapt),
        base_(cases, options.adapting.floor),
        adapting_(&base_, {}, options.adapting) {
    adapting_.tell(object, options.context);
    present_ = withShortened(adapting_.cases());
  }

  /// With the shortened ones, which are made anew whenever one adapts.
  const std::vector<Case>& present() const { return present_; }

  /// The case that was given for the one of a report, which may be a copy made since.
  std::int64_t given(std::int64_t id) const {
    return id < 0 ? id : families(base_.cases()).at(id);
  }

  /// What adapting says, if anything.
  std::string learnFrom(const PushReport& report) {
    if (!adapt_ || !isObservation(report) || report.case_id < 0) return {};
    std::string notice = adapting_.learnFrom(report);
    present_ = withShortened(adapting_.cases());
    return notice;
  }

 private:
  bool adapt_;
  CaseBase base_;
  AdaptingCases adapting_;
  std::vector<Case> present_;
};

}  // namespace

DirectPlanClient::DirectPlanClient(const PushPlanner& planner,
                                   std::function<std::vector<Case>()> cases)
    : planner_(planner), cases_(std::move(cases)) {}

void DirectPlanClient::request(const PlanRequest& request) {
  result_ = planner_.plan(request, cases_());
}

std::optional<PlanResult> DirectPlanClient::poll() { return std::exchange(result_, std::nullopt); }

void DirectPlanClient::cancel() { result_.reset(); }

PushRunResult runPushTask(const Catalog& catalog, const PushProblem& problem,
                          const std::vector<Case>& cases, std::shared_ptr<const Map> map,
                          const PushRunOptions& options,
                          const std::function<void(const PushTask&)>& watch) {
  ClosedLoop loop(catalog, problem.world, options.lab);
  const PushPlanner planner(std::move(map), loop.simulator().robot(),
                            catalog.objectsIn(problem.world), options.planner);
  WorkingCases working(cases, loop.simulator().object(problem.object_id).name, options);
  const auto current_cases = [&working] { return working.present(); };
  DirectPlanClient plans(planner, current_cases);

  PushRunResult result;
  PushTaskServices services;
  services.plans = &plans;
  services.checker = &planner;
  services.cases = current_cases;
  services.clearing = clearWayServices(planner, loop.simulator().robot().name, current_cases);
  services.on_report = [&](const PushReport& report) {
    result.reports.push_back(report);
    result.reports.back().case_id = working.given(report.case_id);
    const std::string notice = working.learnFrom(report);
    if (!notice.empty()) result.noticed.push_back(notice);
  };
  services.on_plan = [&](const PlanResult& plan) { result.planning_s += plan.planning_s; };

  PushTaskGoal goal;
  goal.object_id = problem.object_id;
  goal.map_T_goal = problem.map_T_goal;
  goal.time_limit_s = options.time_limit_s;
  goal.adapt = options.adapt;
  goal.clear_obstacles = options.clear_obstacles;
  goal.seed = options.lab.simulator.seed;
  PushTask task(goal, loop.simulator().robot(), services, options.task);
  loop.run(task, options.time_limit_s + kSettleS, [&] {
    if (watch) {
      watch(task);
    }
  });
  result.sim_time_s = loop.simulator().time();
  loop.idle(kSettleS);

  const Pose2 end = loop.simulator().trueObjectPose(problem.object_id);
  result.status = task.status();
  result.progress = task.progress();
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
