#include <algorithm>
#include <limits>
#include <memory>

#include "casepush/common/input_error.h"
#include "casepush/lab/learning.h"
#include "casepush/world/static_map.h"
#include "command.h"

namespace casepush {
namespace {

struct LearnArguments {
  CommonOptions common;
  std::string object;
  std::string robot = "cobot";
  std::string case_base;
  std::string reset = "place";
  std::string world;
  LearningOptions learning;
};

nlohmann::ordered_json caseSummary(const Case& push_case) {
  const Eigen::Vector3d sigma = push_case.start_outcome.covariance.diagonal().cwiseSqrt();
  return {{"id", push_case.id},
          {"x_m", push_case.start_outcome.mean.x()},
          {"y_m", push_case.start_outcome.mean.y()},
          {"yaw_rad", push_case.start_outcome.mean.yaw()},
          {"sigma_x_m", sigma.x()},
          {"sigma_y_m", sigma.y()},
          {"sigma_yaw_rad", sigma.z()},
          {"push_duration_s", push_case.pushDurationS()},
          {"observations", push_case.observation_count}};
}

std::string progressText(const LearningProgress& now, double elapsed_s, int done_before) {
  std::string text = "learning case " + std::to_string(now.case_number) + "/" +
                     std::to_string(now.cases) + ", practice " +
                     std::to_string(now.practice_number) + "/" + std::to_string(now.practices);
  const int done_here = now.done - done_before;
  if (done_here > 0) {
    const double left_s = elapsed_s / done_here * (now.cases * now.practices - now.done);
    text += ", about " + durationText(left_s) + " left";
  }
  return text;
}

/// The world that was asked for with the object to learn as the only one.
std::optional<WorldModel> room(const LearnArguments& arguments, const Catalog& catalog) {
  if (arguments.world.empty()) {
    return std::nullopt;
  }
  if (arguments.reset != "drive") {
    throw InputError("--world", "needs --reset drive; objects are put back on an open floor");
  }
  WorldModel world = loadWorld(catalog, arguments.world);
  const std::string id = placeObject(world, catalog, arguments.object);
  world.objects.erase(std::remove_if(world.objects.begin(), world.objects.end(),
                                     [&id](const ObjectPlacement& each) { return each.id != id; }),
                      world.objects.end());
  world.robot = arguments.robot;
  return world;
}

int learn(const LearnArguments& arguments) {
  const Stopwatch watch;
  const Catalog catalog = Catalog::standard();
  LearningOptions options = arguments.learning;
  options.exploration.seed = arguments.common.seed;
  options.lab.simulator.seed = arguments.common.seed;
  options.reset = arguments.reset == "drive" ? LabReset::kDrive : LabReset::kPlace;
  options.room = room(arguments, catalog);
  options.exploration.validate();
  // Everything is checked before a case base is made.
  const ObjectModel object = catalog.object(arguments.object);
  const std::string& name = object.name;
  if (options.load) {
    placedLoad(*options.load, object.mechanism, "--load");
  }
  catalog.robot(arguments.robot);
  CaseBase case_base(arguments.case_base, CaseBase::Access::kCreate);
  ProgressLine line;
  int done_before = std::numeric_limits<int>::max();  // By earlier runs.
  const LearningResult result =
      learnInLab(catalog, arguments.object, arguments.robot, case_base, options,
                 [&](const LearningProgress& now) {
                   done_before = std::min(done_before, now.done);
                   line.show(progressText(now, watch.seconds(), done_before));
                   return true;
                 });
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const Case& push_case : case_base.cases(name)) {
    cases.push_back(caseSummary(push_case));
  }
  printResult({{"success", result.success},
               {"explanation", result.explanation},
               {"object", name},
               {"cases", cases},
               {"pushes", result.pushes},
               {"discarded", result.discarded},
               {"brought_back", result.brought_back},
               {"dropped_cases", result.dropped},
               {"collisions", result.collisions},
               {"sim_time_s", result.sim_time_s},
               {"seed", arguments.common.seed},
               {"timing", {{"wall_s", watch.seconds()}}}},
              arguments.common.json);
  return result.success ? kExitSuccess : kExitTaskFailed;
}

}  // namespace

void addLearnCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<LearnArguments>();
  CLI::App* command =
      app.add_subcommand("learn", "Learn cases of an object by pushing it; resumes what was begun");
  addCommonOptions(*command, arguments->common);
  command->add_option("--object", arguments->object, "Object by name or URDF file")->required();
  addRobotOption(*command, arguments->robot);
  command->add_option("--case-base", arguments->case_base, "SQLite file; created if missing")
      ->required();
  ExplorationOptions& exploration = arguments->learning.exploration;
  addCasesOption(*command, exploration);
  addPracticesOption(*command, exploration);
  command
      ->add_option_function<std::string>(
          "--coverage",
          [arguments](const std::string& name) {
            arguments->learning.exploration.coverage = coverageStrategyFromString(name);
          },
          "Which pushes are tried: spread (prefer outcomes not covered yet) or random")
      ->default_str(toString(exploration.coverage));
  command
      ->add_option(
          "--reset", arguments->reset,
          "Between pushes: place (the simulator puts object and robot back, fast) or drive "
          "(the robot drives around the object in a room with walls, nothing is put back)")
      ->check(CLI::IsMember({"place", "drive"}))
      ->capture_default_str();
  command->add_option(
      "--world", arguments->world,
      "For --reset drive: room by name or YAML file; default: 10 x 10 m with walls");
  command
      ->add_option("--jobs", arguments->learning.jobs,
                   "Threads for --reset place; the result does not depend on their number")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  addCasterModelOption(*command, arguments->learning.lab.simulator.caster_model);
  addLoadOption(*command, arguments->learning.load);
  setWork(*command, run, arguments, learn);
}

}  // namespace casepush
