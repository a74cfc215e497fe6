#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>

#include "casepush/cases/case_base.h"
#include "casepush/common/input_error.h"
#include "casepush/lab/plan_benchmark.h"
#include "casepush/lab/quantile.h"
#include "command.h"

namespace casepush {
namespace {

struct PlanBenchArguments {
  CommonOptions common;
  PlanBenchmarkOptions options;
  std::string case_base;
  std::string log;
  std::vector<std::string> planners;
};

nlohmann::ordered_json plannerJson(PlannerKind kind, const std::vector<PlanRun>& runs) {
  std::vector<double> times_s;
  std::vector<double> cpu_s;
  std::vector<double> pushes;
  std::vector<double> nodes;
  int solved = 0;
  for (const PlanRun& run : runs) {
    times_s.push_back(run.planning_s);  // A problem that is not solved costs what it cost.
    cpu_s.push_back(run.cpu_s);
    nodes.push_back(run.nodes);
    if (!run.solved) continue;
    ++solved;
    pushes.push_back(run.pushes);
  }
  return {{"planner", toString(kind)},
          {"success", static_cast<double>(solved) / static_cast<double>(runs.size())},
          {"median_s", quantile(times_s, 0.5)},
          {"p90_s", quantile(times_s, 0.9)},
          {"max_s", quantile(times_s, 1.0)},
          {"median_cpu_s", quantile(cpu_s, 0.5)},
          {"p90_cpu_s", quantile(cpu_s, 0.9)},
          {"max_cpu_s", quantile(cpu_s, 1.0)},
          {"pushes", quantile(pushes, 0.5)},
          {"nodes", quantile(nodes, 0.5)}};
}

/// Ratios to the fastest of OMPL's planners in the same run, in CPU time: wall time on a busy
/// machine favours what is done before the scheduler looks.
nlohmann::ordered_json bestOfOmpl(const PlanBenchmark& measured,
                                  const nlohmann::ordered_json& planners) {
  int best = -1;
  for (std::size_t i = 0; i < measured.planners.size(); ++i) {
    const bool is_faster = best < 0 || planners[i]["median_cpu_s"] < planners[best]["median_cpu_s"];
    if (isOmpl(measured.planners[i]) && is_faster) best = static_cast<int>(i);
  }
  if (best < 0) return nullptr;
  nlohmann::ordered_json ratios;
  const double median_s = planners[best]["median_cpu_s"];
  for (const auto& planner : planners) {
    const double own_s = planner["median_cpu_s"];
    if (own_s > 0.0) ratios[planner["planner"].get<std::string>()] = median_s / own_s;
  }
  return {{"planner", planners[best]["planner"]}, {"times_as_fast", ratios}};
}

enum class Runs { kAll, kFirst };

/// @param world  Empty: all.
nlohmann::ordered_json plannersJson(const PlanBenchmark& measured, const std::string& world,
                                    Runs which) {
  nlohmann::ordered_json planners = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < measured.planners.size(); ++i) {
    std::vector<PlanRun> runs;
    std::copy_if(measured.runs[i].begin(), measured.runs[i].end(), std::back_inserter(runs),
                 [&world, which](const PlanRun& run) {
                   return (world.empty() || run.world == world) &&
                          (which == Runs::kAll || run.run == 0);
                 });
    planners.push_back(plannerJson(measured.planners[i], runs));
  }
  return planners;
}

nlohmann::ordered_json comparisonJson(const PlanBenchmark& measured,
                                      const std::vector<std::string>& names, Runs which) {
  nlohmann::ordered_json worlds;
  nlohmann::ordered_json best_by_world;
  for (const std::string& world : names) {
    worlds[world] = plannersJson(measured, world, which);
    best_by_world[world] = bestOfOmpl(measured, worlds[world]);
  }
  const nlohmann::ordered_json planners = plannersJson(measured, "", which);
  return {{"planners", planners},
          {"best_ompl", bestOfOmpl(measured, planners)},
          {"by_world", worlds},
          {"best_ompl_by_world", best_by_world}};
}

int benchPlan(const PlanBenchArguments& arguments) {
  const Stopwatch watch;
  const std::int64_t started_s = std::time(nullptr);
  PlanBenchmarkOptions options = arguments.options;
  options.seed = arguments.common.seed;
  if (!arguments.planners.empty()) {
    options.planners.clear();
    for (const std::string& name : arguments.planners) {
      options.planners.push_back(plannerKind(name));
    }
  }
  const CaseBase base(arguments.case_base, CaseBase::Access::kReadOnly);
  ProgressLine line;
  const PlanBenchmark measured =
      comparePlanners(Catalog::standard(), base.cases(options.object), options, [&](int problem) {
        line.show("problem " + std::to_string(problem + 1) + "/" +
                  std::to_string(options.problems * static_cast<int>(options.worlds.size())));
      });
  if (!arguments.log.empty()) {
    std::ofstream log(arguments.log);
    writeOmplLog(measured, options, started_s, log);
    if (!log.flush()) throw InputError(arguments.log, "cannot be written");
  }
  nlohmann::ordered_json result = {{"success", true},
                                   {"object", options.object},
                                   {"worlds", options.worlds},
                                   {"problems_per_world", options.problems},
                                   {"runs_per_problem", options.runs},
                                   {"seed", arguments.common.seed}};
  result.update(comparisonJson(measured, options.worlds, Runs::kAll));
  result["first_runs"] = comparisonJson(measured, options.worlds, Runs::kFirst);
  result["timing"] = {{"wall_s", watch.seconds()}};
  printResult(result, arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addPlanBench(CLI::App& bench, Run& run) {
  auto arguments = std::make_shared<PlanBenchArguments>();
  CLI::App* command = bench.add_subcommand(
      "plan", "Compare planners on random problems: time to the first plan, its pushes and nodes");
  addCommonOptions(*command, arguments->common);
  PlanBenchmarkOptions& options = arguments->options;
  addObjectOption(*command, options.object);
  command->add_option("--world,--worlds", options.worlds, "Worlds by name or YAML file, a,b,c")
      ->delimiter(',')
      ->capture_default_str();
  addCaseBaseOption(*command, arguments->case_base);
  command
      ->add_option("--planners", arguments->planners,
                   "Which to compare, as in plan --planner, a,b,c; default: all")
      ->delimiter(',');
  command->add_option("--problems", options.problems, "Random problems in each world")
      ->capture_default_str();
  command
      ->add_option("--runs", options.runs,
                   "Times that each planner is given each problem, one after the other, with other "
                   "seeds; first_runs tells of the first alone")
      ->capture_default_str();
  command->add_option("--deadline", options.deadline_s, "Wall seconds for each plan")
      ->capture_default_str();
  command->add_flag("--improve", options.improve,
                    "Let planners improve their first plan, as casepush push does");
  command->add_option("--log", arguments->log,
                      "Also write an OMPL benchmark log, for Planner Arena");
  setWork(*command, run, arguments, benchPlan);
}

}  // namespace casepush
