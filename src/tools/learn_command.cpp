#include <memory>

#include "casepush/lab/learning.h"
#include "command.h"

namespace casepush {
namespace {

struct LearnArguments {
  CommonOptions common;
  std::string object;
  std::string robot = "cobot";
  std::string case_base;
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

std::string progressText(const LearningProgress& now, double elapsed_s) {
  std::string text = "learning case " + std::to_string(now.case_number) + "/" +
                     std::to_string(now.cases) + ", practice " +
                     std::to_string(now.practice_number) + "/" + std::to_string(now.practices);
  const int done = (now.case_number - 1) * now.practices + now.practice_number - 1;
  if (now.pushes > 0) {
    const double left_s = elapsed_s / now.pushes * (now.cases * now.practices - done);
    text += ", about " + durationText(left_s) + " left";
  }
  return text;
}

int learn(const LearnArguments& arguments) {
  const Stopwatch watch;
  const Catalog catalog = Catalog::standard();
  LearningOptions options = arguments.learning;
  options.exploration.seed = arguments.common.seed;
  options.lab.simulator.seed = arguments.common.seed;
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
  const LearningResult result = learnInLab(catalog, arguments.object, arguments.robot, case_base,
                                           options, [&](const LearningProgress& now) {
                                             line.show(progressText(now, watch.seconds()));
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
               {"dropped_cases", result.dropped},
               {"sim_time_s", result.sim_time_s},
               {"seed", arguments.common.seed},
               {"timing", {{"wall_s", watch.seconds()}}}},
              arguments.common.json);
  return result.success ? kExitSuccess : kExitTaskFailed;
}

}  // namespace

void addLearnCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<LearnArguments>();
  CLI::App* command = app.add_subcommand(
      "learn", "Learn cases of an object by pushing it on an open floor; resumes what was begun");
  addCommonOptions(*command, arguments->common);
  command->add_option("--object", arguments->object, "Object by name or URDF file")->required();
  command->add_option("--robot", arguments->robot, "Robot by name or URDF file")
      ->capture_default_str();
  command->add_option("--case-base", arguments->case_base, "SQLite file; created if missing")
      ->required();
  ExplorationOptions& exploration = arguments->learning.exploration;
  command->add_option("--cases", exploration.cases, "Cases to learn")->capture_default_str();
  command->add_option("--practices", exploration.practices, "Pushes per case")
      ->capture_default_str();
  addCasterModelOption(*command, arguments->learning.lab.simulator.caster_model);
  addLoadOption(*command, arguments->learning.load);
  command->callback([arguments, &run] { run = [arguments] { return learn(*arguments); }; });
}

}  // namespace casepush
