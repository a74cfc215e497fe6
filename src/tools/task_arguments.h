#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/lab/push_run.h"
#include "casepush/planning/risk_options.h"
#include "command.h"

namespace casepush {

/// What `plan` and `push` have in common: object, world, map, cases and goal.
struct TaskArguments {
  CommonOptions common;
  std::string object;
  std::string world = "office";
  std::string map;
  std::string case_base;
  std::vector<double> start;  ///< x_m y_m yaw_deg, or empty.
  std::vector<double> goal;   ///< x_m y_m yaw_deg, or empty.
};

/// --map. @pre `map` lives until the command line is parsed.
void addMapOption(CLI::App& command, std::string& map);

/// @param where  What the pose is given by. @throws InputError if it is not in the world.
void requireInside(const std::string& where, const Pose2& pose, const WorldModel& world);

void addTaskOptions(CLI::App& command, TaskArguments& arguments);

/// How to plan.
struct PlannerArguments {
  std::string planner = "exp_rrt";
  std::string risk = "sigma_points";
  RiskOptions risk_options;
};

/// --planner, --risk, --max-collision-probability, --recovery-time and --risk-horizon.
void addPlannerOptions(CLI::App& command, PlannerArguments& arguments);

/// @throws InputError if there is no such planner, or it knows no chance constraints.
PushPlannerOptions plannerOptions(const PlannerArguments& arguments);

/// Everything loaded and checked.
struct Task {
  Catalog catalog;
  PushProblem problem;
  std::vector<Case> cases;  ///< Of the object.
  std::shared_ptr<const Map> map;
};

/// @param context  In which the object will be pushed: chooses among copies of a case.
/// @throws InputError naming what cannot be used.
Task prepareTask(const TaskArguments& arguments, const PushContext& context = {});

/// Cases of the other objects, which may be pushed out of the way.
std::vector<Case> otherCases(const TaskArguments& arguments, const Task& task);

/// What became of one push: poses are [x m, y m, yaw rad] in the map.
nlohmann::ordered_json pushReportJson(const PushReport& report);

/// {"x_m", "y_m", "yaw_deg"}.
nlohmann::ordered_json poseJson(const Pose2& pose);

}  // namespace casepush
