#include <algorithm>
#include <cmath>
#include <memory>

#include "casepush/common/input_error.h"
#include "casepush/world/map_file.h"
#include "command.h"

namespace casepush {
namespace {

struct MapArguments {
  CommonOptions common;
  std::string input;
  std::string output;
  double occupied_from = 0.65;
  MapFileOptions options;
};

nlohmann::ordered_json pointJson(const Eigen::Vector3d& point) {
  return {point.x(), point.y(), point.z()};
}

nlohmann::ordered_json describe(const Map& map) {
  const MapSize size = sizeOf(map);
  nlohmann::ordered_json json = {
      {"resolution_m", map.resolution()},        {"leaves", size.leaves},
      {"occupied_leaves", size.occupied_leaves}, {"nodes", size.nodes},
      {"occupied_m3", size.occupied_m3},         {"free_m3", size.free_m3},
      {"memory_bytes", size.memory_bytes}};
  if (!map.empty()) {
    json["min_m"] = pointJson(map.min());
    json["max_m"] = pointJson(map.max());
  }
  return json;
}

void finish(nlohmann::ordered_json result, const MapArguments& arguments, const Stopwatch& watch) {
  result["timing"] = {{"wall_s", watch.seconds()}};
  printResult(result, arguments.common.json);
}

int convert(MapArguments arguments) {
  const Stopwatch watch;
  arguments.options.occupancy.occupied_from =
      std::max(1, static_cast<int>(std::lround(100.0 * arguments.occupied_from)));
  const Map map = loadMap(arguments.input, arguments.options);
  map.save(arguments.output);
  nlohmann::ordered_json result = {{"success", true}, {"file", arguments.output}};
  result.update(describe(Map::load(arguments.output)));
  finish(std::move(result), arguments, watch);
  return kExitSuccess;
}

int info(const MapArguments& arguments) {
  const Stopwatch watch;
  nlohmann::ordered_json result = {{"success", true}, {"file", arguments.input}};
  result.update(describe(loadMap(arguments.input, arguments.options)));
  finish(std::move(result), arguments, watch);
  return kExitSuccess;
}

/// What turns the input file into a map.
void addInputOptions(CLI::App& command, MapArguments& arguments) {
  addCommonOptions(command, arguments.common);
  command
      .add_option(
          "input", arguments.input,
          "OctoMap (.bt, .ot), floor plan (.yaml of map_server) or point cloud (.pcd, .xyz)")
      ->required();
  command
      .add_option("--resolution", arguments.options.resolution_m,
                  "Edge of the map's cells [m]; default: an OctoMap's own, 0.05 for the others")
      ->check(finiteIn(0.01, 0.5));
  command
      .add_option("--height", arguments.options.occupancy.height_m,
                  "Height of a floor plan's walls [m]")
      ->check(finiteIn(0.05, 20.0))
      ->capture_default_str();
  command
      .add_option("--occupied-from", arguments.occupied_from,
                  "Cells of a floor plan that are this likely occupied are walls")
      ->check(finiteIn(0.01, 1.0))
      ->capture_default_str();
  command.add_flag("--unknown-is-wall", arguments.options.occupancy.unknown_is_wall,
                   "Unknown cells of a floor plan are walls, too; default: they are free");
}

}  // namespace

void addMapCommand(CLI::App& app, Run& run) {
  CLI::App* map = app.add_subcommand("map", "Look at maps and convert them");
  map->require_subcommand(1);
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* to_file = map->add_subcommand("convert", "Write any map as an OctoMap .bt file");
  addInputOptions(*to_file, *arguments);
  to_file->add_option("output", arguments->output, "File to write (.bt)")->required();
  setWork(*to_file, run, arguments, convert);
  auto shown = std::make_shared<MapArguments>();
  CLI::App* command = map->add_subcommand("info", "Resolution, extent, size and memory of a map");
  addInputOptions(*command, *shown);
  setWork(*command, run, shown, info);
}

}  // namespace casepush
