#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "casepush/lab/task_experiment.h"
#include "command.h"
#include "task_experiment_json.h"

namespace casepush {
namespace {

/// Generous, so that a slow or busy machine does not change the result of a seed.
constexpr double kPlanDeadlineS = 120.0;

struct TaskExperimentArguments {
  CommonOptions common;
  TaskExperimentOptions experiment;
  std::vector<std::string> objects;
  std::vector<std::string> caster_models = {toString(CasterModel::kPlanar),
                                            toString(CasterModel::kFeatherstone)};
  std::vector<int> practices = {1, 3, 5, 10, 20};
  std::string rest_rule = toString(RestRule::kLikelyEnd);
  std::string test = toString(OutcomeTest::kHotelling);
  bool no_break_off = false;
  bool no_notice = false;
  bool replan_when_rejected = false;
};

/// One row of an experiment's table.
struct Row {
  nlohmann::ordered_json label;  ///< What distinguishes it.
  TaskExperimentOptions options;
};

/// Tells how far an experiment is and how long the rest will take at the pace so far.
class ExperimentProgress {
 public:
  explicit ExperimentProgress(std::size_t rows) : rows_(rows) {}

  void update(std::size_t row, const std::string& name, const char* what, int done, int count) {
    const bool is_learning = std::string(what) == "learning";
    const double share =
        (static_cast<double>(row) + (is_learning ? 0.0 : static_cast<double>(done) / count)) /
        static_cast<double>(rows_);
    std::string text =
        name + ": " + what + " " + std::to_string(done) + "/" + std::to_string(count);
    if (share > 0.0) {
      text += ", " + durationText(watch_.seconds() * (1.0 - share) / share) + " left";
    }
    line_.show(text);
  }

 private:
  std::size_t rows_;
  Stopwatch watch_;
  ProgressLine line_;
};

std::string labelText(const nlohmann::ordered_json& label) {
  std::string text;
  for (const auto& [key, value] : label.items()) {
    text += (text.empty() ? "" : ", ") +
            (value.is_string() ? value.get<std::string>() : key + " " + value.dump());
  }
  return text;
}

void printTable(const nlohmann::ordered_json& rows) {
  std::printf("%-46s %6s %13s %7s %8s %9s %7s %5s\n", "", "tasks", "success [%]", "pushes",
              "replans", "in a row", "time s", "hits");
  for (const nlohmann::ordered_json& row : rows) {
    const nlohmann::ordered_json& success = row["success"];
    std::printf("%-46s %6d %5.1f %3.0f-%3.0f %7.1f %8.1f %9.1f %7.1f %5d\n",
                labelText(row["label"]).c_str(), row["tasks"].get<int>(),
                100.0 * success["share"].get<double>(), 100.0 * success["ci95"][0].get<double>(),
                100.0 * success["ci95"][1].get<double>(), row["pushes"]["median"].get<double>(),
                row["replans"]["median"].get<double>(),
                row["median_pushes_before_replan"].get<double>(),
                row["sim_time_s"]["median"].get<double>(), row["collisions"].get<int>());
  }
  std::cout << "Medians of tasks; in a row: pushes before a re-plan; hits: contacts with walls and "
               "furniture\n";
}

int runRows(const TaskExperimentArguments& arguments, const std::vector<Row>& rows) {
  const Stopwatch watch;
  const Catalog catalog = Catalog::standard();
  ExperimentProgress progress(rows.size());
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  nlohmann::ordered_json planning_s = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<TaskRun> runs =
        runTasks(catalog, rows[i].options, [&](const char* what, int done, int count) {
          progress.update(i, labelText(rows[i].label), what, done, count);
        });
    nlohmann::ordered_json row = {{"label", rows[i].label}};
    row.update(taskRunsJson(runs));
    results.push_back(row);
    double seconds = 0.0;
    for (const TaskRun& run : runs) {
      seconds += run.result.planning_s;
    }
    planning_s.push_back(seconds);
  }
  if (!arguments.common.json) {
    printTable(results);
    return kExitSuccess;
  }
  printResult({{"success", true},
               {"rest_rule", arguments.rest_rule},
               {"rest_share", arguments.experiment.run.task.rest.least_share},
               {"horizon", arguments.experiment.run.task.rest.horizon},
               {"replan_when_rejected", arguments.replan_when_rejected},
               {"test", arguments.test},
               {"alpha", arguments.experiment.run.task.push.alpha},
               {"break_off", !arguments.no_break_off},
               {"notice", !arguments.no_notice},
               {"cases", arguments.experiment.learning.exploration.cases},
               {"case_bases", arguments.experiment.case_bases},
               {"rows", results},
               {"seed", arguments.common.seed},
               {"timing", {{"wall_s", watch.seconds()}, {"planning_s", planning_s}}}},
              true);
  return kExitSuccess;
}

TaskExperimentOptions commonOptions(const TaskExperimentArguments& arguments) {
  TaskExperimentOptions options = arguments.experiment;
  options.seed = arguments.common.seed;
  options.run.task.plan_deadline_s = kPlanDeadlineS;
  options.run.task.rest.rule = arguments.rest_rule == toString(RestRule::kMeanAtGoal)
                                   ? RestRule::kMeanAtGoal
                                   : RestRule::kLikelyEnd;
  options.run.task.push.test = arguments.test == toString(OutcomeTest::kPlugIn)
                                   ? OutcomeTest::kPlugIn
                                   : OutcomeTest::kHotelling;
  options.run.task.break_off = !arguments.no_break_off;
  options.run.adapting.notice = !arguments.no_notice;
  options.run.task.rest.replan_when_rejected = arguments.replan_when_rejected;
  return options;
}

void setCasterModel(const std::string& name, TaskExperimentOptions* options) {
  const CasterModel model = casterModelFromString(name);
  options->learning.lab.simulator.caster_model = model;
  options->run.lab.simulator.caster_model = model;
}

int success(const TaskExperimentArguments& arguments) {
  std::vector<Row> rows;
  for (const std::string& object : arguments.objects) {
    for (const std::string& caster_model : arguments.caster_models) {
      Row row{{{"object", object}, {"caster_model", caster_model}}, commonOptions(arguments)};
      row.options.object = object;
      setCasterModel(caster_model, &row.options);
      rows.push_back(row);
    }
  }
  return runRows(arguments, rows);
}

int replans(const TaskExperimentArguments& arguments) {
  std::vector<Row> rows;
  for (const std::string& caster_model : arguments.caster_models) {
    for (const int practices : arguments.practices) {
      Row row{{{"caster_model", caster_model}, {"practices", practices}}, commonOptions(arguments)};
      row.options.setting = TaskSetting::kDiagonal;
      row.options.learning.exploration.practices = practices;
      setCasterModel(caster_model, &row.options);
      rows.push_back(row);
    }
  }
  return runRows(arguments, rows);
}

int adaptation(const TaskExperimentArguments& arguments) {
  std::vector<Row> rows;
  for (const std::string& caster_model : arguments.caster_models) {
    for (const bool loaded : {true, false}) {
      for (const bool adapt : {false, true}) {
        Row row{{{"caster_model", caster_model}, {"loaded", loaded}, {"adapt", adapt}},
                commonOptions(arguments)};
        row.options.setting = TaskSetting::kDiagonal;
        row.options.run.adapt = adapt;
        if (!loaded) {
          row.options.load.reset();
        }
        setCasterModel(caster_model, &row.options);
        rows.push_back(row);
      }
    }
  }
  return runRows(arguments, rows);
}

CLI::App* addExperiment(CLI::App& app, const char* name, const char* description, Run& run,
                        const std::shared_ptr<TaskExperimentArguments>& arguments,
                        int (*work)(const TaskExperimentArguments&)) {
  TaskExperimentOptions& options = arguments->experiment;
  CLI::App* command = app.add_subcommand(name, description);
  addCommonOptions(*command, arguments->common);
  command->add_option("--tasks", options.tasks, "Tasks for each row")->capture_default_str();
  command
      ->add_option("--case-bases", options.case_bases,
                   "Case bases to learn for each row; tasks take turns")
      ->capture_default_str();
  command->add_option("--cases", options.learning.exploration.cases, "Cases to learn")
      ->capture_default_str();
  command
      ->add_option("--caster-models", arguments->caster_models,
                   "How the simulator moves casters, one or both: planar, featherstone")
      ->check(CLI::IsMember({"planar", "featherstone"}))
      ->capture_default_str();
  command->add_option("--jobs", options.jobs, "Threads; the result does not depend on it")
      ->capture_default_str();
  command
      ->add_option("--rest-rule", arguments->rest_rule,
                   "When the rest of a plan is given up: mean_at_goal (as soon as its mean ends "
                   "beside the goal) or likely_end (as soon as it ends at the goal much less "
                   "probably than one that aims right)")
      ->check(CLI::IsMember({"mean_at_goal", "likely_end"}))
      ->capture_default_str();
  command
      ->add_option("--rest-share", options.run.task.rest.least_share,
                   "likely_end: least share of that probability")
      ->check(finiteIn(0.0, 1.0))
      ->capture_default_str();
  command
      ->add_option("--horizon", options.run.task.rest.horizon,
                   "Pushes ahead that must be free of collisions to go on")
      ->capture_default_str();
  command
      ->add_option(
          "--test", arguments->test,
          "Whether a case explains an outcome: hotelling (counts the practices) or plug_in "
          "(as if the case's Gaussian were certain)")
      ->check(CLI::IsMember({"hotelling", "plug_in"}))
      ->capture_default_str();
  command->add_option("--alpha", options.run.task.push.alpha, "Significance of that test")
      ->check(finiteIn(1e-9, 0.5))
      ->capture_default_str();
  command->add_flag("--replan-when-rejected", arguments->replan_when_rejected,
                    "Plan anew after each rejected prediction, also if the rest of the plan still "
                    "leads to the goal with the case as adapted");
  command->add_flag("--no-notice", arguments->no_notice,
                    "Adapt each case for itself, also if pushes give away that load or floor "
                    "changed");
  command->add_flag("--no-break-off", arguments->no_break_off,
                    "Finish pushes whose object leaves its expected course");
  command->callback(
      [arguments, &run, work] { run = [arguments, work] { return work(*arguments); }; });
  return command;
}

void addPractices(CLI::App& command, TaskExperimentOptions& options) {
  command.add_option("--practices", options.learning.exploration.practices, "Pushes per case")
      ->capture_default_str();
}

}  // namespace

void addTaskExperiments(CLI::App& experiment, Run& run) {
  {
    auto arguments = std::make_shared<TaskExperimentArguments>();
    arguments->objects = {"office_chair", "overbed_table", "utility_cart", "stretcher"};
    CLI::App* command = addExperiment(
        experiment, "success",
        "Push objects to goals in random cluttered rooms: share of tasks that succeed by ground "
        "truth (0.2 m, 20 deg), re-plans and their causes, contacts with walls and furniture",
        run, arguments, success);
    command->add_option("--objects", arguments->objects, "Objects by name or URDF file")
        ->capture_default_str();
    command->add_option("--size", arguments->experiment.room_size_m, "Edge of the rooms [m]")
        ->capture_default_str();
    command
        ->add_option("--density", arguments->experiment.room_density,
                     "Share of the floor under furniture")
        ->capture_default_str();
    addPractices(*command, arguments->experiment);
  }
  {
    auto arguments = std::make_shared<TaskExperimentArguments>();
    arguments->experiment.learning.exploration.cases = 7;
    CLI::App* command = addExperiment(
        experiment, "replans",
        "Consecutive pushes before a re-plan over the number of practices (Fig. 8 of the paper): "
        "an open floor, the goal diagonally away",
        run, arguments, replans);
    command->add_option("--object", arguments->experiment.object, "Object by name or URDF file")
        ->capture_default_str();
    command->add_option("--practices", arguments->practices, "Pushes per case, one or several")
        ->capture_default_str();
    command->add_option("--distance", arguments->experiment.goal_distance_m, "To the goal [m]")
        ->capture_default_str();
  }
  {
    auto arguments = std::make_shared<TaskExperimentArguments>();
    arguments->experiment.object = "overbed_table";
    arguments->experiment.goal_distance_m = 10.0;
    arguments->experiment.load.emplace();
    arguments->experiment.load->mass_kg = 15.0;
    CLI::App* command = addExperiment(
        experiment, "adaptation",
        "Cases learnt without a load, used with and without one, adapted or not (Fig. 12 of the "
        "paper): consecutive pushes before a re-plan, the goal diagonally away",
        run, arguments, adaptation);
    command->add_option("--object", arguments->experiment.object, "Object by name or URDF file")
        ->capture_default_str();
    command->add_option("--distance", arguments->experiment.goal_distance_m, "To the goal [m]")
        ->capture_default_str();
    addPractices(*command, arguments->experiment);
    addLoadOption(*command, arguments->experiment.load);
  }
}

}  // namespace casepush
