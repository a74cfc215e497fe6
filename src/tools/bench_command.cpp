#include <algorithm>
#include <cmath>
#include <memory>

#include "bench_cases.h"
#include "casepush/lab/sim_benchmark.h"
#include "command.h"

namespace casepush {
namespace {

constexpr double kLeastSigma = 1e-6;  // Below it an outcome does not vary.

struct BenchArguments {
  CommonOptions common;
  OutcomeComparisonOptions outcomes;
  bool finer = false;
  double speed_s = 60.0;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

nlohmann::ordered_json spread(const std::vector<double>& values) {
  return {{"median", quantile(values, 0.5)}, {"p90", quantile(values, 0.9)}};
}

nlohmann::ordered_json ratios(const std::vector<double>& values) {
  if (values.empty()) return nullptr;  // Nothing varies: the object has no swivels.
  return {{"p10", quantile(values, 0.1)},
          {"median", quantile(values, 0.5)},
          {"p90", quantile(values, 0.9)}};
}

nlohmann::ordered_json comparisonJson(const std::vector<PushComparison>& pushes) {
  std::vector<double> displacement_m, mean_m, mean_rad, run_m, sigma_m, sigma_rad, ratio_m,
      ratio_rad;
  Eigen::Vector2d reference_variance = Eigen::Vector2d::Zero();
  Eigen::Vector2d other_variance = Eigen::Vector2d::Zero();
  for (const PushComparison& push : pushes) {
    const Eigen::Vector3d difference = push.other.mean - push.reference.mean;
    displacement_m.push_back(push.reference.mean.head<2>().norm());
    mean_m.push_back(difference.head<2>().norm());
    mean_rad.push_back(std::abs(difference.z()));
    run_m.insert(run_m.end(), push.run_difference_m.begin(), push.run_difference_m.end());
    sigma_m.push_back(push.reference.position_sigma_m);
    sigma_rad.push_back(push.reference.yaw_sigma_rad);
    if (push.reference.position_sigma_m > kLeastSigma) {
      ratio_m.push_back(push.other.position_sigma_m / push.reference.position_sigma_m);
    }
    if (push.reference.yaw_sigma_rad > kLeastSigma) {
      ratio_rad.push_back(push.other.yaw_sigma_rad / push.reference.yaw_sigma_rad);
    }
    const auto add = [](Eigen::Vector2d& sum, const OutcomeMoments& moments) {
      sum += Eigen::Vector2d(moments.position_sigma_m, moments.yaw_sigma_rad).cwiseAbs2();
    };
    add(reference_variance, push.reference);
    add(other_variance, push.other);
  }
  const auto pooled = [&](int i) -> nlohmann::ordered_json {
    if (reference_variance[i] < kLeastSigma * kLeastSigma) return nullptr;
    return std::sqrt(other_variance[i] / reference_variance[i]);
  };
  return {{"displacement_m", spread(displacement_m)}, {"mean_difference_m", spread(mean_m)},
          {"mean_difference_rad", spread(mean_rad)},  {"run_difference_m", spread(run_m)},
          {"reference_sigma_m", spread(sigma_m)},     {"reference_sigma_rad", spread(sigma_rad)},
          {"sigma_ratio_position", ratios(ratio_m)},  {"sigma_ratio_yaw", ratios(ratio_rad)},
          {"pooled_sigma_ratio_position", pooled(0)}, {"pooled_sigma_ratio_yaw", pooled(1)}};
}

nlohmann::ordered_json compare(const BenchArguments& arguments, const SimulatorOptions& other,
                               const std::string& label, ProgressLine& line) {
  OutcomeComparisonOptions options = arguments.outcomes;
  options.seed = static_cast<std::uint64_t>(arguments.common.seed);
  options.other = other;
  return comparisonJson(compareOutcomes(Catalog::standard(), options, [&](int done) {
    line.show(label + ": push " + std::to_string(done) + "/" + std::to_string(options.pushes));
  }));
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
  SimulatorOptions planar;
  planar.caster_model = CasterModel::kPlanar;
  SimulatorOptions finer;
  finer.step_s *= 0.25;
  finer.solver_iterations *= 2;
  if (arguments.outcomes.pushes > 0) {
    result["planar_against_featherstone"] = compare(arguments, planar, "planar", line);
    if (arguments.finer) {
      result["finer_against_featherstone"] = compare(arguments, finer, "finer", line);
    }
  }
  line.show("measuring speed");
  nlohmann::ordered_json timing = speedJson(arguments);
  timing["wall_s"] = watch.seconds();
  result["timing"] = timing;
  printResult(result, arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addBenchCommand(CLI::App& app, Run& run) {
  auto arguments = std::make_shared<BenchArguments>();
  CLI::App* bench = app.add_subcommand("bench", "Measure parts of casepush");
  bench->require_subcommand(1);
  addBenchCasesCommand(*bench, run);
  CLI::App* command = bench->add_subcommand(
      "sim", "Compare the caster models: outcomes of random pushes as distributions, and speed");
  addCommonOptions(*command, arguments->common);
  OutcomeComparisonOptions& outcomes = arguments->outcomes;
  command->add_option("--object", outcomes.object, "Object by name or URDF file")
      ->capture_default_str();
  command->add_option("--robot", outcomes.robot, "Robot by name or URDF file")
      ->capture_default_str();
  command->add_option("--pushes", outcomes.pushes, "Random pushes; 0: measure speed only")
      ->capture_default_str();
  command->add_option("--swivels", outcomes.swivels, "Random swivel angles for each push")
      ->capture_default_str();
  command->add_option("--jobs", outcomes.jobs, "Threads for the pushes")->capture_default_str();
  command->add_option("--speed-time", arguments->speed_s, "Simulated seconds for measuring speed")
      ->check(CLI::Range(1.0, 36000.0))
      ->capture_default_str();
  command->add_flag("--finer", arguments->finer,
                    "Also compare Featherstone with itself at a quarter of the step");
  command->callback([arguments, &run] { run = [arguments] { return benchSim(*arguments); }; });
}

}  // namespace casepush
