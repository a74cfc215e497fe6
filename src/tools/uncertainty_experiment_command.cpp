#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "casepush/lab/chain_calibration.h"
#include "casepush/lab/mean_interval.h"
#include "casepush/lab/task_experiment.h"
#include "command.h"
#include "task_experiment_json.h"

namespace casepush {
namespace {

/// Generous, so that a slow or busy machine does not change the result of a seed.
constexpr double kPlanDeadlineS = 120.0;

struct UncertaintyArguments {
  CommonOptions common;
  TaskExperimentOptions experiment;
  std::string planner = toString(PlannerKind::kExpRrt);
  RiskOptions risk;
  CasterModel caster_model = CasterModel::kPlanar;
};

/// A way of taking the scatter of pushes into account.
struct Way {
  const char* name;
  RiskModel model;
  double zeta;
};
constexpr Way kWays[] = {{"sigma_points", RiskModel::kSigmaPoints, 3.0},
                         {"mean_only", RiskModel::kSigmaPoints, 0.0},
                         {"chance", RiskModel::kChance, 3.0}};

double pathLengthM(const PushRunResult& result) {
  double length_m = 0.0;
  for (const PushReport& report : result.reports) {
    if (wasMade(report)) length_m += distance(report.map_T_start, report.map_T_end);
  }
  return length_m;
}

struct Measure {
  const char* name;
  double (*value)(const PushRunResult& result);
};
constexpr Measure kMeasures[] = {
    {"success", [](const PushRunResult& result) { return result.success ? 1.0 : 0.0; }},
    {"replans", [](const PushRunResult& result) { return 1.0 * result.progress.replans; }},
    {"repairs", [](const PushRunResult& result) { return 1.0 * result.progress.repairs; }},
    {"replans_and_repairs",
     [](const PushRunResult& result) {
       return 1.0 * (result.progress.replans + result.progress.repairs);
     }},
    {"pushes", [](const PushRunResult& result) { return 1.0 * result.progress.pushes; }},
    {"replans_per_push",
     [](const PushRunResult& result) {
       return result.progress.replans / std::max(1.0, 1.0 * result.progress.pushes);
     }},
    {"path_length_m", pathLengthM},
    {"first_plan_length_m",
     [](const PushRunResult& result) { return result.progress.plan_length_m; }},
    {"sim_time_s", [](const PushRunResult& result) { return result.sim_time_s; }},
    {"collisions", [](const PushRunResult& result) { return 1.0 * result.collisions; }},
};

std::vector<double> column(const std::vector<TaskRun>& runs, const Measure& measure) {
  std::vector<double> values;
  for (const TaskRun& run : runs) values.push_back(measure.value(run.result));
  return values;
}

ReplanCounts causesOf(const std::vector<TaskRun>& runs) {
  ReplanCounts counts;
  for (const TaskRun& run : runs) {
    for (const auto& [cause, count] : run.result.progress.replan_causes) counts[cause] += count;
  }
  return counts;
}

nlohmann::ordered_json calibrationJson(const std::vector<TaskRun>& runs) {
  constexpr int kMostPushes = 8;
  std::vector<std::vector<PushReport>> tasks;
  for (const TaskRun& run : runs) tasks.push_back(run.result.reports);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ChainCalibration& row : calibrateChains(tasks, kMostPushes)) {
    json.push_back({{"pushes", row.pushes},
                    {"chains", row.chains},
                    {"inside_50", row.inside_50},
                    {"inside_90", row.inside_90},
                    {"inside_95", row.inside_95},
                    {"position_rms_m", row.position_rms_m},
                    {"yaw_rms_deg", row.yaw_rms_rad * 180.0 / M_PI}});
  }
  return json;
}

nlohmann::ordered_json intervalJson(const std::vector<double>& values, std::uint64_t seed) {
  const MeanInterval interval = bootstrapInterval(values, seed);
  return {{"mean", interval.mean}, {"ci95", {interval.low, interval.high}}};
}

nlohmann::ordered_json differencesJson(const std::vector<TaskRun>& from,
                                       const std::vector<TaskRun>& to, std::uint64_t seed) {
  nlohmann::ordered_json json;
  for (const Measure& measure : kMeasures) {
    const std::vector<double> before = column(from, measure);
    std::vector<double> difference = column(to, measure);
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= before[i];
    json[measure.name] = intervalJson(difference, seed);
  }
  return json;
}

int uncertainty(const UncertaintyArguments& arguments) {
  const Stopwatch watch;
  const Catalog catalog = Catalog::standard();
  const std::uint64_t seed = arguments.common.seed;
  ProgressLine line;
  nlohmann::ordered_json ways;
  nlohmann::ordered_json differences;
  nlohmann::ordered_json planning_s;
  std::vector<TaskRun> reference;
  for (const Way& way : kWays) {
    TaskExperimentOptions options = arguments.experiment;
    options.seed = seed;
    options.learning.lab.simulator.caster_model = arguments.caster_model;
    options.run.lab.simulator.caster_model = arguments.caster_model;
    options.run.task.plan_deadline_s = kPlanDeadlineS;
    options.run.planner = PushPlannerOptions::forPlanner(plannerKind(arguments.planner));
    options.run.planner.risk = arguments.risk;
    options.run.planner.risk.model = way.model;
    options.run.planner.zeta = way.zeta;
    const std::vector<TaskRun> runs =
        runTasks(catalog, options, [&](const char* what, int done, int count) {
          line.show(std::string(way.name) + ": " + what + " " + std::to_string(done) + "/" +
                    std::to_string(count) + ", " + durationText(watch.seconds()) + " so far");
        });
    nlohmann::ordered_json row;
    for (const Measure& measure : kMeasures) {
      const std::vector<double> values = column(runs, measure);
      row[measure.name] = intervalJson(values, seed);
      row[measure.name]["tasks"] = values;
    }
    row["replan_causes"] = replanCausesJson(causesOf(runs));
    row["calibration"] = calibrationJson(runs);
    ways[way.name] = row;
    planning_s[way.name] = 0.0;
    for (const TaskRun& run : runs) {
      planning_s[way.name] = planning_s[way.name].get<double>() + run.result.planning_s;
    }
    if (reference.empty()) {
      reference = runs;
    } else {
      differences[std::string(way.name) + "_minus_sigma_points"] =
          differencesJson(reference, runs, seed);
    }
  }
  nlohmann::ordered_json result = {
      {"success", true},
      {"object", arguments.experiment.object},
      {"planner", arguments.planner},
      {"caster_model", toString(arguments.caster_model)},
      {"tasks", arguments.experiment.tasks},
      {"max_collision_probability", arguments.risk.max_collision_probability},
      {"recovery_s", arguments.risk.recovery_s},
      {"ways", ways}};
  result.update(differences);
  result["seed"] = seed;
  result["timing"] = {{"wall_s", watch.seconds()}, {"planning_s", planning_s}};
  printResult(result, arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addUncertaintyExperiment(CLI::App& experiment, Run& run) {
  auto arguments = std::make_shared<UncertaintyArguments>();
  TaskExperimentOptions& options = arguments->experiment;
  CLI::App* command = experiment.add_subcommand(
      "uncertainty",
      "Push an object to goals in random cluttered rooms, the same tasks with plans that are safe "
      "at sigma points, for the mean alone, and by chance constraints: re-plans and their "
      "causes, repairs, pushes, path length, time, contacts, and their differences task by task "
      "(95 % bootstrap intervals)");
  addCommonOptions(*command, arguments->common);
  addObjectOption(*command, options.object);
  command->add_option("--tasks", options.tasks, "Tasks for each way")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--case-bases", options.case_bases, "Case bases to learn; tasks take turns")
      ->capture_default_str();
  command->add_option("--planner", arguments->planner, "exp_rrt or lattice")
      ->check(CLI::IsMember({"exp_rrt", "lattice"}))
      ->capture_default_str();
  command
      ->add_option("--max-collision-probability", arguments->risk.max_collision_probability,
                   "Of a whole plan")
      ->check(finiteIn(1e-6, 1.0))
      ->capture_default_str();
  command
      ->add_option("--recovery-time", arguments->risk.recovery_s,
                   "Seconds that a push costs that does not work out")
      ->check(finiteIn(0.0, 3600.0))
      ->capture_default_str();
  command->add_option("--size", options.room_size_m, "Edge of the rooms [m]")
      ->capture_default_str();
  command->add_option("--density", options.room_density, "Share of the floor under furniture")
      ->capture_default_str();
  addJobsOption(*command, options.jobs);
  addCasterModelOption(*command, arguments->caster_model);
  setWork(*command, run, arguments, uncertainty);
}

}  // namespace casepush
