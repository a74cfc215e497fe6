#include "task_arguments.h"

#include <cmath>
#include <sstream>

#include "casepush/cases/case_base.h"
#include "casepush/common/input_error.h"
#include "casepush/world/map_file.h"
#include "casepush/world/static_map.h"

namespace casepush {
namespace {

constexpr double kDegree = M_PI / 180.0;

Pose2 poseFrom(const std::vector<double>& numbers, const std::string& option,
               const WorldModel& world) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw InputError(option, "must be three finite numbers: x_m y_m yaw_deg");
    }
  }
  const Pose2 pose(numbers[0], numbers[1], numbers[2] * kDegree);
  requireInside(option, pose, world);
  return pose;
}

}  // namespace

void requireInside(const std::string& where, const Pose2& pose, const WorldModel& world) {
  if (world.contains(pose)) return;
  const auto text = [](double x_m, double y_m) {
    std::ostringstream stream;
    stream << "(" << x_m << ", " << y_m << ")";
    return stream.str();
  };
  throw InputError(where, text(pose.x(), pose.y()) + " lies outside of world " + world.name +
                              ", which reaches from " + text(world.min_m.x(), world.min_m.y()) +
                              " to " + text(world.max_m.x(), world.max_m.y()) + " m");
}

void addMapOption(CLI::App& command, std::string& map) {
  command.add_option(
      "--map", map,
      "Map that the planner uses: OctoMap (.bt, .ot), floor plan (.yaml of map_server) or "
      "point cloud (.pcd, .xyz); default: a survey of the world");
}

void addTaskOptions(CLI::App& command, TaskArguments& arguments) {
  addCommonOptions(command, arguments.common);
  command.add_option("--object", arguments.object, "Object by name or URDF file")
      ->required()
      ->check(notEmpty());
  command.add_option("--world", arguments.world, "World by name or YAML file")
      ->capture_default_str();
  addMapOption(command, arguments.map);
  addCaseBaseOption(command, arguments.case_base);
  command.add_option("--start", arguments.start, "Object's start: x_m y_m yaw_deg in the map")
      ->expected(3);
  command
      .add_option("--goal", arguments.goal,
                  "Object's goal: x_m y_m yaw_deg in the map; default: a random valid start and "
                  "goal from the seed")
      ->expected(3);
}

void addPlannerOptions(CLI::App& command, PlannerArguments& arguments) {
  command
      .add_option("--planner", arguments.planner,
                  "exp_rrt, exp_rrt_paper, lattice, or one of OMPL's over the same cases: "
                  "ompl_rrt, ompl_sst, ompl_est, ompl_pdst, ompl_kpiece")
      ->capture_default_str();
  RiskOptions& options = arguments.risk_options;
  command
      .add_option("--risk", arguments.risk,
                  "What plans are safe for: sigma_points (of each push for itself) or chance (a "
                  "collision probability for the whole plan; with exp_rrt or lattice)")
      ->check(CLI::IsMember({"sigma_points", "chance"}))
      ->capture_default_str();
  command
      .add_option("--max-collision-probability", options.max_collision_probability,
                  "With --risk chance: of a whole plan")
      ->check(finiteIn(1e-6, 1.0))
      ->capture_default_str();
  command
      .add_option("--recovery-time", options.recovery_s,
                  "With --risk chance: seconds that a push costs that does not work out; the more, "
                  "the more precise pushes are preferred")
      ->check(finiteIn(0.0, 3600.0))
      ->capture_default_str();
  command
      .add_option("--risk-horizon", options.horizon,
                  "With --risk chance: pushes whose scatter adds up before the plan is corrected")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

PushPlannerOptions plannerOptions(const PlannerArguments& arguments) {
  PushPlannerOptions options = PushPlannerOptions::forPlanner(plannerKind(arguments.planner));
  options.risk = arguments.risk_options;
  options.risk.model = riskModel(arguments.risk);
  options.validate();
  return options;
}

Task prepareTask(const TaskArguments& arguments, const PushContext& context) {
  Task task{Catalog::standard(), {}, {}, nullptr};
  const std::string name = task.catalog.object(arguments.object).name;
  const WorldModel world = loadWorld(task.catalog, arguments.world);
  const std::string robot = task.catalog.robot(world.robot).name;
  for (const Case& push_case :
       inContext(CaseBase(arguments.case_base, CaseBase::Access::kReadOnly).cases(name), context)) {
    if (isFor(push_case, name, robot)) {
      task.cases.push_back(push_case);
    }
  }
  if (task.cases.empty()) {
    throw InputError(arguments.case_base, "holds no case of " + name + " pushed by " + robot +
                                              "; run casepush learn --object " + name +
                                              " --case-base " + arguments.case_base);
  }
  if (arguments.goal.empty()) {
    if (!arguments.start.empty()) {
      throw InputError("--start", "needs --goal too");
    }
    task.problem = randomProblem(task.catalog, world, arguments.object, arguments.common.seed);
  } else {
    task.problem = problemFromWorld(task.catalog, world, arguments.object,
                                    poseFrom(arguments.goal, "--goal", world));
    if (!arguments.start.empty()) {
      for (ObjectPlacement& placement : task.problem.world.objects) {
        if (placement.id == task.problem.object_id) {
          placement.map_T_object = poseFrom(arguments.start, "--start", world);
        }
      }
    }
  }
  task.map = arguments.map.empty() ? surveyMap(world)
                                   : std::make_shared<const Map>(loadMap(arguments.map));
  return task;
}

std::vector<Case> otherCases(const TaskArguments& arguments, const Task& task) {
  const std::string name = task.catalog.object(arguments.object).name;
  const std::string robot = task.catalog.robot(task.problem.world.robot).name;
  std::vector<Case> others;
  for (const Case& push_case : inContext(
           CaseBase(arguments.case_base, CaseBase::Access::kReadOnly).cases(), PushContext{})) {
    if (push_case.object != name && push_case.robot == robot) {
      others.push_back(push_case);
    }
  }
  return others;
}

nlohmann::ordered_json pushReportJson(const PushReport& report) {
  if (!wasMade(report)) {
    return {{"object", report.object_id},
            {"case", report.case_id},
            {"outcome", toString(report.outcome)},
            {"explanation", report.explanation}};
  }
  return {{"object", report.object_id},
          {"case", report.case_id},
          {"outcome", toString(report.outcome)},
          {"expected",
           {report.map_expected.mean.x(), report.map_expected.mean.y(),
            report.map_expected.mean.yaw()}},
          {"observed", {report.map_T_end.x(), report.map_T_end.y(), report.map_T_end.yaw()}},
          {"t_squared", report.test.t_squared},
          {"p_value", report.test.p_value},
          {"rejected", report.test.rejected},
          {"start_s", report.start_stamp_s},
          {"duration_s", report.end_stamp_s - report.start_stamp_s}};
}

nlohmann::ordered_json poseJson(const Pose2& pose) {
  return {{"x_m", pose.x()}, {"y_m", pose.y()}, {"yaw_deg", pose.yaw() / kDegree}};
}

}  // namespace casepush
