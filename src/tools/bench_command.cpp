#include <algorithm>
#include <iterator>
#include <memory>

#include "bench_cases.h"
#include "casepush/lab/collision_benchmark.h"
#include "casepush/lab/sim_benchmark.h"
#include "command.h"
#include "sim_bench_json.h"

namespace casepush {
namespace {

// Steps at which the models are compared with a much finer one.
constexpr double kFinestStep_s = 1.0 / 2400.0;
constexpr int kStepRates_hz[] = {120, 240, 480};

struct BenchArguments {
  CommonOptions common;
  OutcomeComparisonOptions outcomes;
  bool fidelity = false;
  bool laws = false;
  double speed_s = 60.0;
};

SimulatorOptions simulatorOf(CasterModel model, double step_s) {
  SimulatorOptions options;
  options.caster_model = model;
  options.step_s = step_s;
  return options;
}

std::vector<PushOutcomes> compare(const BenchArguments& arguments, OutcomeComparisonOptions options,
                                  const std::string& label, ProgressLine& line) {
  options.seed = static_cast<std::uint64_t>(arguments.common.seed);
  return compareOutcomes(Catalog::standard(), options, [&](int done) {
    line.show(label + ": push " + std::to_string(done) + "/" + std::to_string(options.pushes));
  });
}

void addDistributions(const BenchArguments& arguments, ProgressLine& line,
                      nlohmann::ordered_json& result) {
  OutcomeComparisonOptions options = arguments.outcomes;
  options.others = {simulatorOf(CasterModel::kPlanar, options.reference.step_s)};
  const std::vector<PushOutcomes> pushes = compare(arguments, options, "outcomes", line);
  std::vector<PushOutcomes> level;
  std::copy_if(pushes.begin(), pushes.end(), std::back_inserter(level),
               [](const PushOutcomes& push) { return !isTipped(push); });
  result["planar_against_featherstone"] = distributionsJson(pushes, 0);
  result["tipped_pushes"] = pushes.size() - level.size();
  result["planar_against_featherstone_without_tipping"] = distributionsJson(level, 0);
  result["first_push"] = {{"featherstone", outcomesJson(pushes.front().reference)},
                          {"planar", outcomesJson(pushes.front().others[0])}};
}

// A single outcome for each push and model: two draws of swivels are the least that makes sense.
void addFidelity(const BenchArguments& arguments, ProgressLine& line,
                 nlohmann::ordered_json& result) {
  OutcomeComparisonOptions options = arguments.outcomes;
  options.swivels = 2;
  options.reference = simulatorOf(CasterModel::kFeatherstone, kFinestStep_s);
  for (const CasterModel model : {CasterModel::kFeatherstone, CasterModel::kPlanar}) {
    for (const int rate_hz : kStepRates_hz) {
      options.others.push_back(simulatorOf(model, 1.0 / rate_hz));
    }
  }
  const std::vector<PushOutcomes> pushes = compare(arguments, options, "fidelity", line);
  nlohmann::ordered_json& list = result["fidelity"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < options.others.size(); ++i) {
    nlohmann::ordered_json entry{{"caster_model", toString(options.others[i].caster_model)},
                                 {"step_s", options.others[i].step_s},
                                 {"reference_step_s", kFinestStep_s}};
    entry.update(differencesJson(pushes, i));
    list.push_back(entry);
  }
}

void addLaws(ProgressLine& line, nlohmann::ordered_json& result) {
  for (const CasterModel model : {CasterModel::kFeatherstone, CasterModel::kPlanar}) {
    line.show(std::string("laws: ") + toString(model));
    result["laws"][toString(model)] =
        lawsJson(Catalog::standard(), simulatorOf(model, SimulatorOptions().step_s));
  }
}

nlohmann::ordered_json speedJson(const BenchArguments& arguments) {
  nlohmann::ordered_json result;
  std::vector<SimSpeed> speeds;
  for (const CasterModel model : {CasterModel::kFeatherstone, CasterModel::kPlanar}) {
    SimulatorOptions options;
    options.caster_model = model;
    speeds.push_back(measureSimSpeed(Catalog::standard(), arguments.outcomes.object,
                                     arguments.outcomes.robot, options, arguments.speed_s));
    const SimSpeed& speed = speeds.back();
    result[toString(model)] = {{"pushing_all_x_real_time", speed.pushing_all},
                               {"pushing_one_x_real_time", speed.pushing_one},
                               {"driving_x_real_time", speed.driving},
                               {"world_recreation_ms", 1e3 * speed.recreation_s}};
  }
  result["planar_over_featherstone"] = {
      {"pushing_all", speeds[1].pushing_all / speeds[0].pushing_all},
      {"pushing_one", speeds[1].pushing_one / speeds[0].pushing_one},
      {"driving", speeds[1].driving / speeds[0].driving}};
  return result;
}

int benchSim(const BenchArguments& arguments) {
  const Stopwatch watch;
  ProgressLine line;
  nlohmann::ordered_json result{{"success", true},
                                {"object", arguments.outcomes.object},
                                {"pushes", arguments.outcomes.pushes},
                                {"swivels", arguments.outcomes.swivels},
                                {"seed", arguments.common.seed}};
  if (arguments.outcomes.pushes > 0) {
    addDistributions(arguments, line, result);
    if (arguments.fidelity) addFidelity(arguments, line, result);
  }
  if (arguments.laws) addLaws(line, result);
  line.show("measuring speed");
  nlohmann::ordered_json timing = speedJson(arguments);
  const SensorCost sensors = measureSensorCost(Catalog::standard(), "office", arguments.speed_s);
  timing["sensors_in_office"] = {{"us_per_ray", 1e6 * sensors.ray_s},
                                 {"us_per_tag_image", 1e6 * sensors.image_s},
                                 {"range_sensors_s_per_simulated_s", sensors.scanning_share}};
  timing["wall_s"] = watch.seconds();
  result["timing"] = timing;
  printResult(result, arguments.common.json);
  return kExitSuccess;
}

}  // namespace

namespace {

struct CollisionArguments {
  CommonOptions common;
  CollisionBenchmarkOptions options;
};

/// ", 2 min 10 s left", once that can be told.
std::string timeLeft(double spent_s, int done, int all) {
  if (done == 0) return "";
  return ", " + durationText(spent_s / done * (all - done)) + " left";
}

nlohmann::ordered_json tableJson(const StaticTableCost& cost) {
  return {{"build_s", cost.build_s},
          {"memory_mb", cost.memory_mb},
          {"masks_for_all_pushes_tests_per_s", cost.mask_tests_per_s},
          {"pays_from_tests", cost.pays_from_tests}};
}

int benchCollision(const CollisionArguments& arguments) {
  const Stopwatch watch;
  ProgressLine line;
  CollisionBenchmarkOptions options = arguments.options;
  options.seed = arguments.common.seed;
  const CollisionBenchmark measured =
      measureCollisionChecking(Catalog::standard(), options, [&](int done) {
        line.show(std::to_string(done) + "/" + std::to_string(options.tests) + " tests" +
                  timeLeft(watch.seconds(), done, options.tests));
      });
  nlohmann::ordered_json backends = nlohmann::ordered_json::array();
  const double fcl = measured.backends.front().tests_per_s;
  int missed = 0;
  for (const CollisionBackend& backend : measured.backends) {
    missed += backend.missed;
    backends.push_back({{"backend", backend.name},
                        {"tests_per_s", backend.tests_per_s},
                        {"over_fcl", fcl > 0.0 ? backend.tests_per_s / fcl : 0.0},
                        {"missed", backend.missed},
                        {"extra", backend.extra}});
  }
  nlohmann::ordered_json result{{"success", missed == 0},
                                {"object", options.object},
                                {"robot", options.robot},
                                {"tests", measured.tests},
                                {"collisions", measured.collisions},
                                {"contacts", measured.contacts},
                                {"seed", arguments.common.seed},
                                {"backends", backends}};
  if (options.static_table) result["static_table"] = tableJson(measured.static_table);
  result["timing"] = {
      {"mask_ms", measured.mask_ms}, {"map_ms", measured.map_ms}, {"wall_s", watch.seconds()}};
  printResult(result, arguments.common.json);
  return missed == 0 ? kExitSuccess : kExitTaskFailed;
}

void addCollisionBench(CLI::App& bench, Run& run) {
  auto arguments = std::make_shared<CollisionArguments>();
  CLI::App* command = bench.add_subcommand(
      "collision",
      "Compare ways of testing a whole push for collisions: FCL on the OctoMap, pose by pose on "
      "columns, sweep masks exactly and conservatively");
  addCommonOptions(*command, arguments->common);
  CollisionBenchmarkOptions& options = arguments->options;
  addObjectOption(*command, options.object);
  addRobotOption(*command, options.robot);
  command->add_option("--tests", options.tests, "Random tests over all rooms")
      ->capture_default_str();
  command->add_option("--rooms", options.rooms, "Random rooms")->capture_default_str();
  command->add_option("--motions", options.motions, "Random pushes in each room")
      ->capture_default_str();
  command->add_option("--resolution", options.resolution_m, "Cell of the OctoMap [m]")
      ->capture_default_str();
  command->add_flag("--static-table", options.static_table,
                    "Also measure a table made beforehand that answers for all pushes at a start "
                    "at once");
  setWork(*command, run, arguments, benchCollision);
}

}  // namespace

void addBenchCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = app.add_subcommand("bench", "Measure parts of casepush");
  bench->require_subcommand(1);
  addBenchCasesCommand(*bench, run);
  addCollisionBench(*bench, run);
  addPlanBench(*bench, run);
  addMapBench(*bench, run);
  addGrowthBench(*bench, run);
  CLI::App* command = bench->add_subcommand(
      "sim", "Compare the caster models: outcomes of random pushes as distributions, and speed");
  addCommonOptions(*command, arguments->common);
  OutcomeComparisonOptions& outcomes = arguments->outcomes;
  addObjectOption(*command, outcomes.object);
  addRobotOption(*command, outcomes.robot);
  command->add_option("--pushes", outcomes.pushes, "Random pushes; 0: measure speed only")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  command->add_option("--swivels", outcomes.swivels, "Random swivel angles for each push")
      ->capture_default_str();
  command->add_option("--jobs", outcomes.jobs, "Threads for the pushes")->capture_default_str();
  command->add_option("--speed-time", arguments->speed_s, "Simulated seconds for measuring speed")
      ->check(CLI::Range(1.0, 36000.0))
      ->capture_default_str();
  command->add_flag("--fidelity", arguments->fidelity,
                    "Also compare both models at several steps with Featherstone at 1/2400 s, push "
                    "by push");
  command->add_flag("--laws", arguments->laws,
                    "Also measure push force, start-up force, coasting and trailing of a cart");
  setWork(*command, run, arguments, benchSim);
}

}  // namespace casepush
