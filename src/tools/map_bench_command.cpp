#include <memory>

#include "casepush/cases/case_base.h"
#include "casepush/lab/map_benchmark.h"
#include "command.h"

namespace casepush {
namespace {

struct MapBenchArguments {
  CommonOptions common;
  MapBenchmarkOptions options;
  std::string case_base;
};

nlohmann::ordered_json plansJson(const std::vector<MapBenchmark::Plan>& plans) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const MapBenchmark::Plan& plan : plans) {
    json.push_back({{"planner", toString(plan.planner)},
                    {"solved", plan.solved},
                    {"explanation", plan.explanation},
                    {"made_s", plan.made_s},
                    {"first_s", plan.first_s},
                    {"again_s", plan.again_s},
                    {"after_change",
                     {{"update_told_s", plan.update_told_s},
                      {"update_compared_s", plan.update_compared_s},
                      {"first_s", plan.updated_first_s}}},
                    {"pushes", plan.pushes},
                    {"length_m", plan.length_m},
                    {"nodes", plan.nodes}});
  }
  return json;
}

int benchMap(const MapBenchArguments& arguments) {
  const Stopwatch watch;
  MapBenchmarkOptions options = arguments.options;
  options.building.seed = arguments.common.seed;
  const CaseBase base(arguments.case_base, CaseBase::Access::kReadOnly);
  ProgressLine line;
  const MapBenchmark measured =
      measureMap(Catalog::standard(), base.cases(options.building.object), options,
                 [&](const std::string& what) { line.show("measuring: " + what); });
  printResult(
      {{"success", true},
       {"size_m", options.building.size_m},
       {"resolution_m", options.resolution_m},
       {"occupied_leaves", measured.size.occupied_leaves},
       {"octomap_mb", static_cast<double>(measured.size.memory_bytes) / 1e6},
       {"file_mb", measured.file_mb},
       {"survey_s", measured.survey_s},
       {"save_s", measured.save_s},
       {"load_s", measured.load_s},
       {"checker_s", measured.checker_s},
       {"update", {{"octomap_s", measured.update_map_s}, {"checker_s", measured.update_checker_s}}},
       {"plans", plansJson(measured.plans)},
       {"seed", arguments.common.seed},
       {"timing", {{"wall_s", watch.seconds()}}}},
      arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addMapBench(CLI::App& bench, Run& run) {
  auto arguments = std::make_shared<MapBenchArguments>();
  MapBenchmarkOptions& options = arguments->options;
  CLI::App* command = bench.add_subcommand(
      "map",
      "What a large building costs: memory, reading, changes of a 1 m box, plans from corner to "
      "corner");
  addCommonOptions(*command, arguments->common);
  addCaseBaseOption(*command, arguments->case_base);
  addObjectOption(*command, options.building.object);
  addRobotOption(*command, options.building.robot);
  command->add_option("--size", options.building.size_m, "Edge length of the building [m]")
      ->capture_default_str();
  command->add_option("--resolution", options.resolution_m, "Cell of the OctoMap [m]")
      ->capture_default_str();
  command->add_option("--deadline", options.deadline_s, "Wall seconds for each plan")
      ->capture_default_str();
  setWork(*command, run, arguments, benchMap);
}

}  // namespace casepush
