#pragma once

#include <string>
#include <vector>

#include "casepush/lab/task_experiment.h"
#include "command.h"
#include "task_arguments.h"

namespace casepush {

/// What experiments of push tasks have in common.
struct TaskExperimentArguments {
  CommonOptions common;
  TaskExperimentOptions experiment;
  PlannerArguments planner;
  std::vector<std::string> objects;
  std::string rooms = "random";
  std::vector<std::string> caster_models = {toString(CasterModel::kPlanar),
                                            toString(CasterModel::kFeatherstone)};
  std::vector<int> practices = {1, 3, 5, 10, 20};
  std::string rest_rule = toString(RestRule::kLikelyEnd);
  std::string test = toString(OutcomeTest::kHotelling);
  bool no_break_off = false;
  bool no_watch_ahead = false;
  bool no_notice = false;
  bool replan_when_rejected = false;
  bool no_repair = false;
  bool plans_only = false;
};

/// One row of an experiment's table.
struct Row {
  nlohmann::ordered_json label;  ///< What distinguishes it.
  TaskExperimentOptions options;
};

/// All runs of an experiment, row by row.
struct Results {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<std::vector<TaskRun>> runs;
  nlohmann::ordered_json planning_s = nlohmann::ordered_json::array();
  nlohmann::ordered_json timing = nlohmann::ordered_json::object();  ///< What else was timed.
};

/// Runs all tasks of all rows, telling how far it is.
Results runAll(const std::vector<Row>& rows);

void printTable(const nlohmann::ordered_json& rows);

/// @param more  What else belongs to the result.
void printJson(const TaskExperimentArguments& arguments, const Results& results,
               const Stopwatch& watch, const nlohmann::ordered_json& more);

}  // namespace casepush
