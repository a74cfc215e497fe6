#include "task_experiment_rows.h"

#include <cstdio>
#include <iostream>

#include "task_experiment_json.h"

namespace casepush {
namespace {

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

/// Learning takes minutes: what does not exist is told of before.
void checkNames(const Catalog& catalog, const TaskExperimentOptions& options) {
  catalog.object(options.object);
  for (const std::string& name : options.movable) catalog.object(name);
  if (options.setting == TaskSetting::kWorld) catalog.world(options.world);
}

}  // namespace

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

Results runAll(const std::vector<Row>& rows) {
  const Catalog catalog = Catalog::standard();
  for (const Row& row : rows) checkNames(catalog, row.options);
  ExperimentProgress progress(rows.size());
  Results results;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    results.runs.push_back(
        runTasks(catalog, rows[i].options, [&](const char* what, int done, int count) {
          progress.update(i, labelText(rows[i].label), what, done, count);
        }));
    nlohmann::ordered_json row = {{"label", rows[i].label}};
    if (rows[i].options.execute) row.update(taskRunsJson(results.runs.back()));
    results.rows.push_back(row);
    double seconds = 0.0;
    for (const TaskRun& run : results.runs.back()) {
      seconds += run.result.planning_s;
    }
    results.planning_s.push_back(seconds);
  }
  return results;
}

void printJson(const TaskExperimentArguments& arguments, const Results& results,
               const Stopwatch& watch, const nlohmann::ordered_json& more) {
  nlohmann::ordered_json json = {{"success", true},
                                 {"rest_rule", arguments.rest_rule},
                                 {"rest_share", arguments.experiment.run.task.rest.least_share},
                                 {"horizon", arguments.experiment.run.task.rest.horizon},
                                 {"replan_when_rejected", arguments.replan_when_rejected},
                                 {"repair", !arguments.no_repair},
                                 {"test", arguments.test},
                                 {"alpha", arguments.experiment.run.task.push.alpha},
                                 {"break_off", !arguments.no_break_off},
                                 {"watch_ahead", !arguments.no_watch_ahead},
                                 {"notice", !arguments.no_notice},
                                 {"risk", arguments.planner.risk},
                                 {"cases", arguments.experiment.learning.exploration.cases},
                                 {"case_bases", arguments.experiment.case_bases},
                                 {"rows", results.rows}};
  json.update(more);
  json["seed"] = arguments.common.seed;
  json["timing"] = {{"wall_s", watch.seconds()}, {"planning_s", results.planning_s}};
  json["timing"].update(results.timing);
  printResult(json, true);
}

}  // namespace casepush
