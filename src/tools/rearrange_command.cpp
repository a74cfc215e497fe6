#include <cmath>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "casepush/cases/case_base.h"
#include "casepush/common/input_error.h"
#include "casepush/lab/rearrange_run.h"
#include "casepush/world/map_file.h"
#include "casepush/world/static_map.h"
#include "command.h"
#include "task_arguments.h"

namespace casepush {
namespace {

/// Generous, so that a slow or busy machine does not change the result of a seed.
constexpr double kPlanDeadlineS = 120.0;

struct RearrangeArguments {
  CommonOptions common;
  std::string world;
  std::string map;
  std::string case_base;
  std::vector<std::string> goals;
  PlannerArguments planner;
  bool no_adapt = false;
  bool clear_obstacles = false;
  CasterModel caster_model = CasterModel::kFeatherstone;
  double time_limit_s = 3600.0;
};

/// "chair_1:2.4,0,90".
PushTaskGoal goalFrom(const std::string& text, const WorldModel& world) {
  const std::string where = "--goal " + text;
  const std::size_t colon = text.find(':');
  std::istringstream numbers(colon == std::string::npos ? "" : text.substr(colon + 1));
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_deg = 0.0;
  char commas[2] = {};
  std::string rest;
  const bool is_read =
      static_cast<bool>(numbers >> x_m >> commas[0] >> y_m >> commas[1] >> yaw_deg);
  if (!is_read || commas[0] != ',' || commas[1] != ',' || numbers >> rest || colon == 0) {
    throw InputError(where, "must be id:x,y,yaw with x and y in m and yaw in degrees");
  }
  PushTaskGoal goal;
  goal.object_id = text.substr(0, colon);
  goal.map_T_goal = Pose2(x_m, y_m, yaw_deg * M_PI / 180.0);
  requireInside(where, goal.map_T_goal, world);
  return goal;
}

RearrangeRequest requestFrom(const RearrangeArguments& arguments, const WorldModel& world) {
  RearrangeRequest request;
  request.time_limit_s = arguments.time_limit_s;
  for (const std::string& text : arguments.goals) {
    PushTaskGoal goal = goalFrom(text, world);
    goal.time_limit_s = arguments.time_limit_s;
    goal.adapt = !arguments.no_adapt;
    goal.clear_obstacles = arguments.clear_obstacles;
    goal.seed = arguments.common.seed;
    request.tasks.push_back(goal);
  }
  return request;
}

/// One line for each phase of each object.
class RearrangeProgress {
 public:
  void update(const Rearrange& rearrange) {
    const PushTask* task = rearrange.task();
    if (task == nullptr) return;
    const auto state =
        std::make_tuple(rearrange.turn(), task->progress().pushes, task->progress().plans);
    if (state == last_) return;
    last_ = state;
    line_.show(rearrange.describe());
  }

 private:
  ProgressLine line_;
  std::tuple<std::size_t, int, int> last_;
};

nlohmann::ordered_json objectJson(const RearrangeRunResult::Object& object,
                                  const PushTaskGoal& goal) {
  return {{"object", object.item.object_id},
          {"goal", poseJson(goal.map_T_goal)},
          {"at_goal", object.at_goal},
          {"status", toString(object.item.status)},
          {"explanation", object.item.explanation},
          {"turns", object.item.attempts},
          {"pushes", object.item.pushes},
          {"position_error_m", object.position_error_m},
          {"yaw_error_rad", object.yaw_error_rad}};
}

int rearrange(const RearrangeArguments& arguments) {
  const Stopwatch watch;
  const Catalog catalog = Catalog::standard();
  const WorldModel world = loadWorld(catalog, arguments.world);
  const RearrangeRequest request = requestFrom(arguments, world);
  PushRunOptions options;
  options.lab.simulator.seed = arguments.common.seed;
  options.lab.simulator.caster_model = arguments.caster_model;
  options.planner = plannerOptions(arguments.planner);
  options.adapt = !arguments.no_adapt;
  options.task.plan_deadline_s = kPlanDeadlineS;
  std::vector<Case> cases =
      inContext(CaseBase(arguments.case_base, CaseBase::Access::kReadOnly).cases(), PushContext{});
  const std::shared_ptr<const Map> map = arguments.map.empty()
                                             ? surveyMap(world)
                                             : std::make_shared<const Map>(loadMap(arguments.map));
  RearrangeProgress progress;
  const RearrangeRunResult result =
      runRearrange(catalog, world, request, cases, map, options,
                   [&progress](const Rearrange& now) { progress.update(now); });
  nlohmann::ordered_json objects = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.objects.size(); ++i) {
    objects.push_back(objectJson(result.objects[i], request.tasks[i]));
  }
  nlohmann::ordered_json pushes = nlohmann::ordered_json::array();
  for (const PushReport& report : result.reports) pushes.push_back(pushReportJson(report));
  printResult({{"success", result.success},
               {"status", toString(result.status)},
               {"explanation", result.explanation},
               {"objects", objects},
               {"order", result.order},
               {"sim_time_s", result.sim_time_s},
               {"collisions", result.collisions},
               {"collision_names", result.collision_names},
               {"world", world.name},
               {"push_reports", pushes},
               {"seed", arguments.common.seed},
               {"timing", {{"wall_s", watch.seconds()}, {"planning_s", result.planning_s}}}},
              arguments.common.json);
  return result.success ? kExitSuccess : kExitTaskFailed;
}

}  // namespace

void addRearrangeCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<RearrangeArguments>();
  CLI::App* command = app.add_subcommand(
      "rearrange",
      "Push several objects of a world to goals, one after the other, in the simulator");
  addCommonOptions(*command, arguments->common);
  command->add_option("--world", arguments->world, "World by name or YAML file")
      ->required()
      ->check(notEmpty());
  addMapOption(*command, arguments->map);
  addCaseBaseOption(*command, arguments->case_base);
  command
      ->add_option("--goal", arguments->goals,
                   "Goal of an object of the world, once for each: id:x,y,yaw in the map, m and "
                   "degrees, e.g. chair_1:2.4,0,90")
      ->required()
      ->take_all();
  addPlannerOptions(*command, arguments->planner);
  command->add_flag("--no-adapt", arguments->no_adapt, "Do not adapt the cases while pushing");
  command->add_flag("--clear-obstacles", arguments->clear_obstacles,
                    "Push other objects whose cases are in the case base out of the way where that "
                    "is expected to be quicker than going around; without it they are fixed");
  command->add_option("--time-limit", arguments->time_limit_s, "Simulated seconds for all objects")
      ->check(finiteIn(1.0, 360000.0))
      ->capture_default_str();
  addCasterModelOption(*command, arguments->caster_model);
  setWork(*command, run, arguments, rearrange);
}

}  // namespace casepush
