#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "obstacle_json.h"
#include "task_experiment_rows.h"

namespace casepush {
namespace {

/// Generous, so that a slow or busy machine does not change the result of a seed.
constexpr double kPlanDeadlineS = 120.0;

int runRows(const TaskExperimentArguments& arguments, const std::vector<Row>& rows) {
  const Stopwatch watch;
  const Results results = runAll(rows);
  if (arguments.common.json) {
    printJson(arguments, results, watch, nlohmann::ordered_json::object());
  } else {
    printTable(results.rows);
  }
  return kExitSuccess;
}

TaskExperimentOptions commonOptions(const TaskExperimentArguments& arguments) {
  TaskExperimentOptions options = arguments.experiment;
  options.seed = arguments.common.seed;
  options.run.task.plan_deadline_s = kPlanDeadlineS;
  options.run.task.clear.deadline_s = kPlanDeadlineS;
  options.run.planner = plannerOptions(arguments.planner);
  if (arguments.rooms == "random") {
    options.setting = TaskSetting::kRandomRooms;
  } else if (arguments.rooms == "divided") {
    options.setting = TaskSetting::kDividedRooms;
  } else if (arguments.rooms == "varied") {
    options.setting = TaskSetting::kVariedRooms;
  } else {
    options.setting = TaskSetting::kWorld;
    options.world = arguments.rooms;
  }
  options.run.task.rest.rule = arguments.rest_rule == toString(RestRule::kMeanAtGoal)
                                   ? RestRule::kMeanAtGoal
                                   : RestRule::kLikelyEnd;
  options.run.task.push.test = arguments.test == toString(OutcomeTest::kPlugIn)
                                   ? OutcomeTest::kPlugIn
                                   : OutcomeTest::kHotelling;
  options.run.task.break_off = !arguments.no_break_off;
  options.run.task.push.watch_ahead = !arguments.no_watch_ahead;
  options.run.adapting.notice = !arguments.no_notice;
  options.run.task.rest.replan_when_rejected = arguments.replan_when_rejected;
  options.run.task.rest.repair = !arguments.no_repair;
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

/// Rows of both kinds for each caster model, in turn.
std::vector<Row> obstacleRows(const TaskExperimentArguments& arguments) {
  std::vector<Row> rows;
  for (const std::string& caster_model : arguments.caster_models) {
    for (const char* kind : {"stationary", "movable"}) {
      Row row{{{"caster_model", caster_model}, {"obstacles", kind}}, commonOptions(arguments)};
      row.options.setting = TaskSetting::kVariedRooms;
      row.options.run.clear_obstacles = std::string(kind) == "movable";
      row.options.execute = !arguments.plans_only;
      setCasterModel(caster_model, &row.options);
      rows.push_back(row);
    }
  }
  return rows;
}

int obstacles(const TaskExperimentArguments& arguments) {
  const Stopwatch watch;
  Results results = runAll(obstacleRows(arguments));
  for (std::size_t i = 0; i < results.runs.size(); ++i) {
    results.rows[i]["plans"] = planTrialsJson(results.runs[i]);
    results.timing["plans_s"].push_back(planTimesJson(results.runs[i]));
  }
  nlohmann::ordered_json detours = nlohmann::ordered_json::array();
  std::vector<std::vector<DetourBin>> bins;
  for (std::size_t i = 0; !arguments.plans_only && i < arguments.caster_models.size(); ++i) {
    const std::vector<ObstaclePair> pairs =
        obstaclePairs(results.runs[2 * i], results.runs[2 * i + 1]);
    bins.push_back(binByDetour(pairs, static_cast<std::uint64_t>(arguments.common.seed)));
    detours.push_back({{"caster_model", arguments.caster_models[i]},
                       {"bins", detourJson(bins.back())},
                       {"pairs", pairsJson(pairs)}});
  }
  if (arguments.common.json) {
    printJson(arguments, results, watch, {{"stationary_over_movable", detours}});
    return kExitSuccess;
  }
  if (!arguments.plans_only) printTable(results.rows);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    std::printf("\n%s: how many times as long tasks take if the obstacles are fixed\n",
                arguments.caster_models[i].c_str());
    printDetours(bins[i]);
  }
  printPlanTrials(results.rows, results.timing["plans_s"]);
  return kExitSuccess;
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
  addCasesOption(*command, options.learning.exploration);
  command
      ->add_option("--caster-models", arguments->caster_models,
                   "How the simulator moves casters, one or both: planar, featherstone")
      ->check(CLI::IsMember({"planar", "featherstone"}))
      ->capture_default_str();
  addJobsOption(*command, options.jobs);
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
  command->add_flag("--no-repair", arguments->no_repair,
                    "Give a plan up where its end misses the goal, instead of planning the pushes "
                    "after the next one anew while that one is made");
  command->add_flag("--no-notice", arguments->no_notice,
                    "Adapt each case for itself, also if pushes give away that load or floor "
                    "changed");
  addPlannerOptions(*command, arguments->planner);
  command->add_flag("--no-break-off", arguments->no_break_off,
                    "Finish pushes whose object leaves its expected course");
  command->add_flag("--no-watch-ahead", arguments->no_watch_ahead,
                    "Finish pushes whose object is about to touch something");
  setWork(*command, run, arguments, work);
  return command;
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
    command
        ->add_option("--rooms", arguments->rooms,
                     "random (each task in a cluttered room of its own), divided (in one with two "
                     "doors, the short way through the one), varied (the same with measures and "
                     "obstacles drawn at random), or a world by name or YAML file with random "
                     "starts and goals")
        ->capture_default_str();
    command
        ->add_option("--movable", arguments->experiment.movable,
                     "Other objects by name or URDF file: among the furniture of random rooms, in "
                     "the near door of divided ones, one or two of them in that of varied ones")
        ->expected(0, 5);
    command->add_flag("--clear-obstacles", arguments->experiment.run.clear_obstacles,
                      "Learn other objects, too, and push them out of the way where that is "
                      "expected to be quicker; without it they are fixed");
    command->add_option("--size", arguments->experiment.room_size_m, "Edge of the rooms [m]")
        ->capture_default_str();
    command
        ->add_option("--density", arguments->experiment.room_density,
                     "Share of the floor under furniture")
        ->capture_default_str();
    addPracticesOption(*command, arguments->experiment.learning.exploration);
  }
  {
    auto arguments = std::make_shared<TaskExperimentArguments>();
    arguments->experiment.learning.exploration.cases = 7;
    CLI::App* command = addExperiment(
        experiment, "replans",
        "Consecutive pushes before a re-plan over the number of practices (Fig. 8 of the paper): "
        "an open floor, the goal diagonally away",
        run, arguments, replans);
    addObjectOption(*command, arguments->experiment.object);
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
    addObjectOption(*command, arguments->experiment.object);
    command->add_option("--distance", arguments->experiment.goal_distance_m, "To the goal [m]")
        ->capture_default_str();
    addPracticesOption(*command, arguments->experiment.learning.exploration);
    addLoadOption(*command, arguments->experiment.load);
  }
  {
    auto arguments = std::make_shared<TaskExperimentArguments>();
    arguments->experiment.object = "overbed_table";
    arguments->experiment.movable = {"office_chair", "utility_cart"};
    arguments->experiment.room_density = 0.03;
    arguments->experiment.plans = 5;
    CLI::App* command = addExperiment(
        experiment, "obstacles",
        "Tasks in rooms with a short way through a door in which other objects stand, and a free "
        "one through another door (Table 1 and Fig. 11 of the paper): the same tasks with these "
        "objects fixed and pushed out of the way, over the length of the detour. Measures of the "
        "rooms and obstacles are drawn at random",
        run, arguments, obstacles);
    addObjectOption(*command, arguments->experiment.object);
    command
        ->add_option("--movable", arguments->experiment.movable,
                     "What may stand in the door, by name or URDF file: one or two of these, drawn "
                     "for each room")
        ->expected(1, 5)
        ->capture_default_str();
    command
        ->add_option("--plans", arguments->experiment.plans,
                     "Plans for each room and kind of obstacles; the shortest ones tell how long "
                     "the detour is")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    command->add_flag("--plans-only", arguments->plans_only,
                      "Execute nothing: number of nodes, length and CPU time of plans only");
    addPracticesOption(*command, arguments->experiment.learning.exploration);
  }
}

}  // namespace casepush
