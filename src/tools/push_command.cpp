#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "casepush/cases/adapting_cases.h"
#include "casepush/common/input_error.h"
#include "command.h"
#include "task_arguments.h"
#include "task_experiment_json.h"

namespace casepush {
namespace {

/// Generous, so that a slow or busy machine does not change the result of a seed.
constexpr double kPlanDeadlineS = 120.0;

struct PushArguments {
  TaskArguments task;
  PlannerArguments planner;
  bool no_adapt = false;
  bool clear_obstacles = false;
  int clear_ahead = ClearWayOptions().pushes_ahead;
  bool keep = false;
  CasterModel caster_model = CasterModel::kFeatherstone;
  std::optional<Load> load;
  double time_limit_s = 1200.0;
};

/// One line for each plan and each push; the shorter phases in between would only flicker.
std::string progressText(const PushTask& task) {
  const PushTaskProgress& now = task.progress();
  if (now.phase != "push" && now.phase != "planning") {
    return "";
  }
  char text[160];
  if (now.phase == "planning") {
    std::snprintf(text, sizeof text, "planning, %d pushes and %d re-plans so far", now.pushes,
                  now.replans);
  } else {
    std::snprintf(text, sizeof text,
                  "push %d of %d (%d in all, %d re-plans), %.2f m and %.0f deg to go",
                  now.push_index, now.push_count, now.pushes + 1, now.replans,
                  now.distance_to_goal_m, std::abs(now.yaw_to_goal_rad) * 180.0 / M_PI);
  }
  return text;
}

/// Shows each change of the text once: the distances in it change all the time.
class PushProgress {
 public:
  void update(const PushTask& task) {
    const PushTaskProgress& now = task.progress();
    const auto state = std::make_tuple(now.phase, now.pushes, now.replans);
    if (state != last_) {
      last_ = state;
      line_.show(progressText(task));
    }
  }

 private:
  ProgressLine line_;
  std::tuple<std::string, int, int> last_;
};

PushContext contextOf(const PushArguments& arguments) {
  PushContext context;
  context.load_kg = arguments.load ? arguments.load->mass_kg : 0.0;
  return context;
}

/// Adapts the stored cases as the task adapted its own. A case that was learnt with another load is
/// copied first, and keeps what it knew.
void keepWhatWasLearnt(const PushArguments& arguments, const std::string& object,
                       const std::vector<PushReport>& reports) {
  CaseBase base(arguments.task.case_base, CaseBase::Access::kReadWrite);
  AdaptingCases adapting(&base, {});
  adapting.tell(object, contextOf(arguments));
  for (const PushReport& report : reports) {
    if (isObservation(report) && report.case_id > 0) {
      adapting.learnFrom(report);
    }
  }
}

int push(const PushArguments& arguments) {
  const Stopwatch watch;
  if (arguments.keep && arguments.no_adapt) {
    throw InputError("--keep", "needs adaptation; leave --no-adapt out");
  }
  Task task = prepareTask(arguments.task, contextOf(arguments));
  PushRunOptions options;
  options.lab.simulator.seed = arguments.task.common.seed;
  options.lab.simulator.caster_model = arguments.caster_model;
  if (arguments.load) {
    options.lab.simulator.loads[task.problem.object_id] = *arguments.load;
  }
  options.planner = plannerOptions(arguments.planner);
  options.context = contextOf(arguments);
  options.adapt = !arguments.no_adapt;
  options.clear_obstacles = arguments.clear_obstacles;
  if (arguments.clear_obstacles) {
    const std::vector<Case> others = otherCases(arguments.task, task);
    task.cases.insert(task.cases.end(), others.begin(), others.end());
  }
  options.time_limit_s = arguments.time_limit_s;
  options.task.plan_deadline_s = kPlanDeadlineS;
  options.task.clear.deadline_s = kPlanDeadlineS;
  options.task.clear.pushes_ahead = arguments.clear_ahead;
  PushProgress progress;
  const PushRunResult result =
      runPushTask(task.catalog, task.problem, task.cases, task.map, options,
                  [&](const PushTask& now) { progress.update(now); });
  if (result.status == PushTaskStatus::kInvalidGoal) {
    throw InputError("push", result.explanation);
  }
  const ObjectPlacement* start = nullptr;
  for (const ObjectPlacement& placement : task.problem.world.objects) {
    if (placement.id == task.problem.object_id) {
      start = &placement;
    }
  }
  if (arguments.keep) {
    keepWhatWasLearnt(arguments, start->model, result.reports);
  }
  nlohmann::ordered_json pushes = nlohmann::ordered_json::array();
  for (const PushReport& report : result.reports) {
    pushes.push_back(pushReportJson(report));
  }
  printResult({{"success", result.success},
               {"status", toString(result.status)},
               {"explanation", result.explanation},
               {"position_error_m", result.position_error_m},
               {"yaw_error_rad", result.yaw_error_rad},
               {"pushes", result.progress.pushes},
               {"clearing_pushes", result.progress.clearing_pushes},
               {"replans", result.progress.replans},
               {"repairs", result.progress.repairs},
               {"replan_causes", replanCausesJson(result.progress.replan_causes)},
               {"replan_reasons", result.progress.replan_reasons},
               {"rejected_predictions", result.progress.rejected_predictions},
               {"noticed_changes", result.noticed},
               {"plan_length_m", result.progress.plan_length_m},
               {"sim_time_s", result.sim_time_s},
               {"collisions", result.collisions},
               {"collision_names", result.collision_names},
               {"object", task.problem.object_id},
               {"world", task.problem.world.name},
               {"start", poseJson(start->map_T_object)},
               {"goal", poseJson(task.problem.map_T_goal)},
               {"push_reports", pushes},
               {"seed", arguments.task.common.seed},
               {"timing", {{"wall_s", watch.seconds()}, {"planning_s", result.planning_s}}}},
              arguments.task.common.json);
  return result.success ? kExitSuccess : kExitTaskFailed;
}

}  // namespace

void addPushCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<PushArguments>();
  CLI::App* command =
      app.add_subcommand("push", "Push an object to a goal in the simulator, planning from cases");
  addTaskOptions(*command, arguments->task);
  addPlannerOptions(*command, arguments->planner);
  command->add_flag("--no-adapt", arguments->no_adapt, "Do not adapt the cases while pushing");
  command->add_flag("--clear-obstacles", arguments->clear_obstacles,
                    "Push other objects whose cases are in the case base out of the way where that "
                    "is expected to "
                    "be quicker than going around; without it they are fixed");
  command
      ->add_option("--clear-ahead", arguments->clear_ahead,
                   "With --clear-obstacles: pushes that must be clear before the next one is made")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--keep", arguments->keep,
                    "Write the adapted cases to the case base: those learnt with another load are "
                    "copied for this one first; without it the file is not changed");
  command->add_option("--time-limit", arguments->time_limit_s, "Simulated seconds for the task")
      ->check(finiteIn(1.0, 36000.0))
      ->capture_default_str();
  addCasterModelOption(*command, arguments->caster_model);
  addLoadOption(*command, arguments->load);
  setWork(*command, run, arguments, push);
}

}  // namespace casepush
