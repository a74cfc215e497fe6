#include <cmath>
#include <memory>

#include "casepush/common/input_error.h"
#include "casepush/lab/plan_verification.h"
#include "command.h"
#include "task_arguments.h"

namespace casepush {
namespace {

struct PlanArguments {
  TaskArguments task;
  double deadline_s = 10.0;
  PlannerArguments planner;
  bool paper = false;
  bool verify = false;
  int draws = 200;
  bool anytime = false;
};

PushPlannerOptions optionsFor(const PlanArguments& arguments) {
  PlannerArguments chosen = arguments.planner;
  if (arguments.paper) chosen.planner = toString(PlannerKind::kExpRrtPaper);
  PushPlannerOptions options = plannerOptions(chosen);
  if (arguments.anytime) options.improveUntilDeadline();
  return options;
}

/// Wrong from the start, in contrast to a search without success.
bool isBadRequest(PlanStatus status) {
  switch (status) {
    case PlanStatus::kInvalidRequest:
    case PlanStatus::kNoCases:
    case PlanStatus::kStartInCollision:
    case PlanStatus::kGoalInCollision:
    case PlanStatus::kGoalOutsideMap:
      return true;
    default:
      return false;
  }
}

/// Sets `valid`.
nlohmann::ordered_json verify(const PlanArguments& arguments, const Task& task,
                              const PlanRequest& request, const PushPlan& plan, bool* valid) {
  std::vector<PlacedSolid> obstacles;
  const std::map<std::string, ObjectModel> models = task.catalog.objectsIn(task.problem.world);
  for (const PlacedObject& obstacle : request.obstacles) {
    obstacles.push_back({models.at(obstacle.model).solid, obstacle.map_T_object, obstacle.id});
  }
  const ObjectModel& object = models.at(request.object.model);
  const RobotModel robot = task.catalog.robot(task.problem.world.robot);
  const PlanVerification verified =
      verifyPlan(*task.map, obstacles, object, robot, plan, task.cases);
  const RiskVerification risk = verifyRisk(*task.map, obstacles, object, robot, plan, task.cases,
                                           arguments.planner.risk_options.horizon, arguments.draws,
                                           arguments.task.common.seed);
  *valid = verified.valid && risk.valid;
  return {{"valid", *valid},
          {"poses", verified.poses},
          {"explanation", verified.explanation},
          {"draws", risk.draws},
          {"collision_probability", risk.collision_probability},
          {"collision_probability_ci95", {risk.low, risk.high}},
          {"goal_probability", risk.goal_probability}};
}

/// Standard deviations along and across the object's heading and of the heading.
nlohmann::ordered_json sigmaJson(const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return {{"x_m", sigma.x()}, {"y_m", sigma.y()}, {"yaw_deg", sigma.z() * 180.0 / M_PI}};
}

/// Only chance constraints estimate it.
nlohmann::ordered_json collisionJson(const PushPlan& plan) {
  return plan.max_collision_probability ? nlohmann::ordered_json(plan.collision_probability)
                                        : nlohmann::ordered_json(nullptr);
}

int plan(const PlanArguments& arguments) {
  const Stopwatch watch;
  const Task task = prepareTask(arguments.task);
  const PushPlannerOptions options = optionsFor(arguments);
  const PushPlanner planner(task.map, task.catalog.robot(task.problem.world.robot),
                            task.catalog.objectsIn(task.problem.world), options);
  const PlanRequest request =
      requestFor(task.catalog, task.problem, arguments.task.common.seed, arguments.deadline_s);
  const PlanResult result = planner.plan(request, task.cases);
  if (isBadRequest(result.status)) {
    throw InputError("plan", result.explanation);
  }
  nlohmann::ordered_json pushes = nlohmann::ordered_json::array();
  for (const PlannedPush& push : result.plan.pushes) {
    pushes.push_back({{"case", push.case_id},
                      {"start", poseJson(push.map_T_start)},
                      {"outcome", poseJson(push.map_outcome.mean)},
                      {"compounded_sigma", sigmaJson(push.map_compounded.covariance)}});
  }
  const bool solved = result.status == PlanStatus::kSolved;
  nlohmann::ordered_json verification;
  bool valid = true;
  if (solved && arguments.verify) {
    verification = verify(arguments, task, request, result.plan, &valid);
  }
  printResult({{"success", solved && valid},
               {"status", toString(result.status)},
               {"explanation", result.explanation},
               {"planner", toString(options.planner)},
               {"pushes", result.plan.pushes.size()},
               {"plan_length_m", result.plan.lengthM()},
               {"expected_s", result.expected_s},
               {"bound", result.bound},
               {"risk", toString(options.risk.model)},
               {"collision_probability", collisionJson(result.plan)},
               {"goal_probability", result.plan.goal_probability},
               {"nodes", result.nodes},
               {"collision_checks", result.collision_checks},
               {"start", poseJson(request.object.map_T_object)},
               {"goal", poseJson(request.map_T_goal)},
               {"plan", pushes},
               {"verification", verification},
               {"seed", arguments.task.common.seed},
               {"timing", {{"wall_s", watch.seconds()}, {"planning_s", result.planning_s}}}},
              arguments.task.common.json);
  return solved && valid ? kExitSuccess : kExitTaskFailed;
}

}  // namespace

void addPlanCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = app.add_subcommand("plan", "Plan the pushes that bring an object to a goal");
  addTaskOptions(*command, arguments->task);
  command->add_option("--deadline", arguments->deadline_s, "Wall seconds for planning")
      ->check(finiteIn(0.001, 3600.0))
      ->capture_default_str();
  addPlannerOptions(*command, arguments->planner);
  command->add_flag(
      "--verify", arguments->verify,
      "Test the plan once more with FCL on the OctoMap, slowly and independently, and "
      "random executions of it");
  command->add_option("--draws", arguments->draws, "With --verify: random executions to test")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_flag("--anytime", arguments->anytime,
                    "Use all the time until the deadline to look for a quicker plan (exp_rrt)");
  command->add_flag("--paper", arguments->paper, "The same as --planner exp_rrt_paper");
  setWork(*command, run, arguments, plan);
}

}  // namespace casepush
