#include <memory>

#include "casepush/lab/coverage_experiment.h"
#include "command.h"

namespace casepush {
namespace {

struct CoverageArguments {
  CommonOptions common;
  CoverageExperimentOptions experiment;
};

struct Measure {
  const char* name;
  double CoverageMeasures::*value;
};
constexpr Measure kMeasures[] = {
    {"learning_pushes", &CoverageMeasures::pushes},
    {"mean_distance_tolerances", &CoverageMeasures::mean_distance},
    {"reach_2_pushes", &CoverageMeasures::reach_2},
    {"reach_3_pushes", &CoverageMeasures::reach_3},
    {"turning_cases", &CoverageMeasures::turning_cases},
    {"planned", &CoverageMeasures::planned},
    {"plan_pushes", &CoverageMeasures::plan_pushes},
};

nlohmann::ordered_json intervalJson(const std::vector<double>& values) {
  const MeanInterval interval = meanInterval(values);
  return {{"mean", interval.mean}, {"ci95", {interval.low, interval.high}}, {"seeds", values}};
}

std::vector<double> column(const std::vector<CoverageMeasures>& all,
                           double CoverageMeasures::*value) {
  std::vector<double> values;
  for (const CoverageMeasures& each : all) {
    values.push_back(each.*value);
  }
  return values;
}

int coverage(const CoverageArguments& arguments) {
  const Stopwatch watch;
  CoverageExperimentOptions options = arguments.experiment;
  options.seed = arguments.common.seed;
  ProgressLine line;
  const CoverageExperimentResult result = coverageExperiment(
      Catalog::standard(), options, [&](const std::string& text) { line.show(text); });
  nlohmann::ordered_json random, spread, difference;
  for (const Measure& measure : kMeasures) {
    std::vector<double> a = column(result.random, measure.value);
    const std::vector<double> b = column(result.spread, measure.value);
    random[measure.name] = intervalJson(a);
    spread[measure.name] = intervalJson(b);
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = b[i] - a[i];
    }
    difference[measure.name] = intervalJson(a);
  }
  printResult({{"success", true},
               {"object", options.object},
               {"world", options.world},
               {"cases", options.learning.exploration.cases},
               {"practices", options.learning.exploration.practices},
               {"caster_model", toString(options.learning.lab.simulator.caster_model)},
               {"problems_per_seed", options.problems},
               {"random", random},
               {"spread", spread},
               {"spread_minus_random", difference},
               {"seed", arguments.common.seed},
               {"timing", {{"wall_s", watch.seconds()}}}},
              arguments.common.json);
  return kExitSuccess;
}

void addCoverage(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<CoverageArguments>();
  CoverageExperimentOptions& options = arguments->experiment;
  options.learning.lab.simulator.caster_model = CasterModel::kPlanar;
  CLI::App* command = app.add_subcommand(
      "coverage",
      "Learn with pushes chosen at random and chosen to spread, and compare: distance from a "
      "wanted "
      "displacement to the nearest case [goal tolerances], share of nearby poses that chains of "
      "two "
      "and three cases reach, cases that turn by more than 0.3 rad, plans for random problems");
  addCommonOptions(*command, arguments->common);
  command->add_option("--object", options.object, "Object by name or URDF file")
      ->capture_default_str();
  command->add_option("--world", options.world, "Where the problems are set")
      ->capture_default_str();
  command->add_option("--seeds", options.seeds, "Case bases to learn with each strategy")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--problems", options.problems, "Problems to plan with each case base")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  command->add_option("--cases", options.learning.exploration.cases, "Cases to learn")
      ->capture_default_str();
  command->add_option("--practices", options.learning.exploration.practices, "Pushes per case")
      ->capture_default_str();
  command->add_option("--jobs", options.learning.jobs, "Threads; the result does not depend on it")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  addCasterModelOption(*command, options.learning.lab.simulator.caster_model);
  command->callback([arguments, &run] { run = [arguments] { return coverage(*arguments); }; });
}

}  // namespace

void addExperimentCommand(CLI::App& app, Run& run) {
  CLI::App* command =
      app.add_subcommand("experiment", "Compare ways of learning and planning over many seeds");
  command->require_subcommand(1);
  addCoverage(*command, run);
}

}  // namespace casepush
