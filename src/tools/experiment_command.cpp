#include <memory>

#include "casepush/lab/coverage_experiment.h"
#include "casepush/lab/mean_interval.h"
#include "casepush/lab/transfer_experiment.h"
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

template <typename Measures, typename Value>
std::vector<double> column(const std::vector<Measures>& all, const Value& value) {
  std::vector<double> values;
  for (const Measures& each : all) {
    values.push_back(value(each));
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
    const auto value = [&](const CoverageMeasures& each) { return each.*measure.value; };
    std::vector<double> a = column(result.random, value);
    const std::vector<double> b = column(result.spread, value);
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
  addObjectOption(*command, options.object);
  command->add_option("--world", options.world, "Where the problems are set")
      ->capture_default_str();
  command->add_option("--seeds", options.seeds, "Case bases to learn with each strategy")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--problems", options.problems, "Problems to plan with each case base")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  addCasesOption(*command, options.learning.exploration);
  addPracticesOption(*command, options.learning.exploration);
  addJobsOption(*command, options.learning.jobs);
  addCasterModelOption(*command, options.learning.lab.simulator.caster_model);
  setWork(*command, run, arguments, coverage);
}

struct TransferArguments {
  CommonOptions common;
  TransferExperimentOptions experiment;
};

/// One row for each number of practices from `first`.
nlohmann::ordered_json qualityJson(const std::vector<TransferMeasures>& all,
                                   std::vector<PredictionQuality> TransferMeasures::*way,
                                   std::size_t first) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t k = first; k < (all.front().*way).size(); ++k) {
    nlohmann::ordered_json row = {{"practices", k}};
    const auto add = [&](const char* name, double PredictionQuality::*value) {
      row[name] = intervalJson(
          column(all, [&](const TransferMeasures& each) { return (each.*way)[k].*value; }));
    };
    add("mean_error_tolerances", &PredictionQuality::mean_error);
    add("sigma_ratio", &PredictionQuality::sigma_ratio);
    add("surprise_nat", &PredictionQuality::surprise);
    rows.push_back(row);
  }
  return rows;
}

int transfer(const TransferArguments& arguments) {
  const Stopwatch watch;
  TransferExperimentOptions options = arguments.experiment;
  options.seed = arguments.common.seed;
  ProgressLine line;
  const std::vector<TransferMeasures> all = transferExperiment(
      Catalog::standard(), options, [&](const std::string& text) { line.show(text); });
  printResult(
      {{"success", true},
       {"from", options.from},
       {"to", options.to},
       {"caster_model", toString(options.learning.lab.simulator.caster_model)},
       {"tests", options.tests},
       {"cases", column(all, [](const TransferMeasures& each) { return each.cases; })},
       {"useless_cases", column(all, [](const TransferMeasures& each) { return each.useless; })},
       {"transferred", qualityJson(all, &TransferMeasures::transferred, 0)},
       {"scratch", qualityJson(all, &TransferMeasures::scratch, 1)},
       {"seed", arguments.common.seed},
       {"timing", {{"wall_s", watch.seconds()}}}},
      arguments.common.json);
  return kExitSuccess;
}

void addTransfer(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<TransferArguments>();
  TransferExperimentOptions& options = arguments->experiment;
  options.learning.lab.simulator.caster_model = CasterModel::kPlanar;
  CLI::App* command = app.add_subcommand(
      "transfer",
      "Give the cases of a known object to a new one, practise them there, and compare after each "
      "practice how well they predict with cases learnt from those practices alone: error of the "
      "mean [goal tolerances], predicted over real standard deviation, surprise [nat]");
  addCommonOptions(*command, arguments->common);
  command->add_option("--from", options.from, "Known object by name or URDF file")
      ->capture_default_str();
  command->add_option("--to", options.to, "New object by name or URDF file")->capture_default_str();
  command->add_option("--seeds", options.seeds, "Case bases to learn and transfer")
      ->capture_default_str();
  command->add_option("--practices", options.practices, "Of each transferred case")
      ->capture_default_str();
  command->add_option("--tests", options.tests, "Pushes of each case that only judge")
      ->capture_default_str();
  command->add_option("--cases", options.learning.exploration.cases, "Cases to learn and transfer")
      ->capture_default_str();
  command
      ->add_option("--learning-practices", options.learning.exploration.practices,
                   "Pushes per case of the known object")
      ->capture_default_str();
  addCasterModelOption(*command, options.learning.lab.simulator.caster_model);
  setWork(*command, run, arguments, transfer);
}

}  // namespace

void addExperimentCommand(CLI::App& app, Run& run) {
  CLI::App* command =
      app.add_subcommand("experiment", "Compare ways of learning and planning over many seeds");
  command->require_subcommand(1);
  addCoverage(*command, run);
  addTransfer(*command, run);
  addTaskExperiments(*command, run);
  addUncertaintyExperiment(*command, run);
}

}  // namespace casepush
