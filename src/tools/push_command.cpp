#include <memory>

#include "command.h"
#include "task_arguments.h"

namespace casepush {
namespace {

struct PushArguments {
  TaskArguments task;
  bool no_adapt = false;
  double time_limit_s = 1200.0;
};

std::string progressText(const PushTask& task) {
  const PushTaskProgress& now = task.progress();
  return now.phase + ": push " + std::to_string(now.push_index) + " of " +
         std::to_string(now.push_count) + ", " + std::to_string(now.pushes) + " done, " +
         std::to_string(now.replans) + " re-plans";
}

nlohmann::ordered_json pushJson(const PushReport& report) {
  return {{"case", report.case_id},
          {"outcome", toString(report.outcome)},
          {"expected",
           {report.map_expected.mean.x(), report.map_expected.mean.y(),
            report.map_expected.mean.yaw()}},
          {"observed", {report.map_T_end.x(), report.map_T_end.y(), report.map_T_end.yaw()}},
          {"t_squared", report.test.t_squared},
          {"p_value", report.test.p_value},
          {"rejected", report.test.rejected},
          {"duration_s", report.end_stamp_s - report.start_stamp_s}};
}

int push(const PushArguments& arguments) {
  const Stopwatch watch;
  Task task = prepareTask(arguments.task);
  PushRunOptions options;
  options.lab.simulator.seed = arguments.task.common.seed;
  options.adapt = !arguments.no_adapt;
  options.time_limit_s = arguments.time_limit_s;
  ProgressLine line(true);
  const PushRunResult result =
      runPushTask(task.catalog, task.problem, task.cases, task.map, options,
                  [&](const PushTask& now) { line.show(progressText(now)); });
  nlohmann::ordered_json pushes = nlohmann::ordered_json::array();
  for (const PushReport& report : result.reports) {
    pushes.push_back(pushJson(report));
  }
  const ObjectPlacement* start = nullptr;
  for (const ObjectPlacement& placement : task.problem.world.objects) {
    if (placement.id == task.problem.object_id) {
      start = &placement;
    }
  }
  printResult({{"success", result.success},
               {"status", toString(result.status)},
               {"explanation", result.explanation},
               {"position_error_m", result.position_error_m},
               {"yaw_error_rad", result.yaw_error_rad},
               {"pushes", result.progress.pushes},
               {"replans", result.progress.replans},
               {"rejected_predictions", result.progress.rejected_predictions},
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
  command->add_flag("--no-adapt", arguments->no_adapt,
                    "Do not adapt the cases while pushing (the file is never changed)");
  command->add_option("--time-limit", arguments->time_limit_s, "Simulated seconds for the task")
      ->check(CLI::Range(1.0, 36000.0))
      ->capture_default_str();
  command->callback([arguments, &run] { run = [arguments] { return push(*arguments); }; });
}

}  // namespace casepush
