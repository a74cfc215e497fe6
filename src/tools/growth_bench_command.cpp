#include <memory>

#include "casepush/cases/case_base.h"
#include "casepush/lab/growth_benchmark.h"
#include "command.h"

namespace casepush {
namespace {

struct GrowthBenchArguments {
  CommonOptions common;
  GrowthBenchmarkOptions options;
  std::string case_base;
};

nlohmann::ordered_json treesJson(const std::vector<GrowthBenchmark::Tree>& trees) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const GrowthBenchmark::Tree& tree : trees) {
    json.push_back({{"cases", tree.cases},
                    {"nodes", tree.nodes},
                    {"median_cpu_s", tree.median_cpu_s},
                    {"max_cpu_s", tree.max_cpu_s},
                    {"per_node_us", tree.per_node_us}});
  }
  return json;
}

nlohmann::ordered_json firstJson(const std::vector<GrowthBenchmark::First>& plans, int problems) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const GrowthBenchmark::First& first : plans) {
    json.push_back({{"cases", first.cases},
                    {"success", static_cast<double>(first.solved) / problems},
                    {"median_cpu_s", first.median_cpu_s},
                    {"max_cpu_s", first.max_cpu_s}});
  }
  return json;
}

nlohmann::ordered_json lateJson(const std::vector<GrowthBenchmark::Late>& calls) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const GrowthBenchmark::Late& late : calls) {
    json.push_back({{"planner", toString(late.planner)},
                    {"deadline_s", late.deadline_s},
                    {"cases", late.cases},
                    {"late_s", late.late_s},
                    {"nodes", late.nodes}});
  }
  return json;
}

int benchGrowth(const GrowthBenchArguments& arguments) {
  const Stopwatch watch;
  GrowthBenchmarkOptions options = arguments.options;
  options.seed = arguments.common.seed;
  const CaseBase base(arguments.case_base, CaseBase::Access::kReadOnly);
  ProgressLine line;
  const GrowthBenchmark measured =
      measureGrowth(Catalog::standard(), base.cases(options.object), options,
                    [&](const std::string& what) { line.show("measuring: " + what); });
  printResult({{"success", true},
               {"object", options.object},
               {"world", options.world},
               {"problems", options.problems},
               {"seed", options.seed},
               {"by_nodes", treesJson(measured.by_nodes)},
               {"by_cases", treesJson(measured.by_cases)},
               {"first_plans", firstJson(measured.first, options.problems)},
               {"deadlines", lateJson(measured.late)},
               {"timing", {{"wall_s", watch.seconds()}}}},
              arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addGrowthBench(CLI::App& bench, Run& run) {
  auto arguments = std::make_shared<GrowthBenchArguments>();
  GrowthBenchmarkOptions& options = arguments->options;
  CLI::App* command = bench.add_subcommand(
      "growth",
      "How fast Exp-RRT grows towards a goal that it never meets, how first plans depend on the "
      "number of cases, and how late planners return after a deadline");
  addCommonOptions(*command, arguments->common);
  addCaseBaseOption(*command, arguments->case_base);
  addObjectOption(*command, options.object);
  command->add_option("--world", options.world, "World by name or YAML file")
      ->capture_default_str();
  command->add_option("--nodes", options.nodes, "Sizes of the trees, a,b,c")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--cases", options.case_counts,
                   "How many cases, a,b,c: the given ones and copies turned about the object")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--problems", options.problems, "Random problems")->capture_default_str();
  command->add_option("--deadlines", options.deadlines_s, "Wall seconds, a,b,c; 0.0001 or more")
      ->delimiter(',')
      ->capture_default_str();
  setWork(*command, run, arguments, benchGrowth);
}

}  // namespace casepush
