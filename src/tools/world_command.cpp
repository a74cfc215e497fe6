#include <memory>

#include "casepush/lab/divided_room.h"
#include "casepush/lab/room_generator.h"
#include "command.h"
#include "task_arguments.h"

namespace casepush {
namespace {

struct GenerateArguments {
  CommonOptions common;
  RoomOptions room;
  bool divided = false;
  bool varied = false;
  std::string output;
};

int generate(GenerateArguments arguments) {
  const Stopwatch watch;
  arguments.room.seed = static_cast<std::uint64_t>(arguments.common.seed);
  DividedRoomOptions divided;
  divided.seed = arguments.room.seed;
  divided.size_m = arguments.room.size_m;
  divided.object = arguments.room.object;
  divided.robot = arguments.room.robot;
  const Catalog catalog = Catalog::standard();
  if (arguments.varied) divided = drawDividedRoom(catalog, divided);
  const WorldModel room = arguments.divided || arguments.varied
                              ? generateDividedRoom(catalog, divided)
                              : generateRoom(catalog, arguments.room);
  saveWorldModel(room, arguments.output);
  printResult({{"success", true},
               {"file", arguments.output},
               {"boxes", room.boxes.size()},
               {"start", poseJson(room.objects.front().map_T_object)},
               {"goal", poseJson(*room.goal)},
               {"robot", poseJson(room.map_T_robot)},
               {"seed", arguments.common.seed},
               {"timing", {{"wall_s", watch.seconds()}}}},
              arguments.common.json);
  return kExitSuccess;
}

}  // namespace

void addWorldCommand(CLI::App& app, Run& run) {
  CLI::App* world = app.add_subcommand("world", "Make worlds");
  world->require_subcommand(1);
  auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* command = world->add_subcommand(
      "generate", "Write a cluttered room in which the object can be pushed from start to goal");
  addCommonOptions(*command, arguments->common);
  addObjectOption(*command, arguments->room.object);
  addRobotOption(*command, arguments->room.robot);
  CLI::Option* size =
      command->add_option("--size", arguments->room.size_m, "Edge length of the room [m]")
          ->capture_default_str();
  command->add_option("--density", arguments->room.density, "Share of the floor under furniture")
      ->capture_default_str();
  command->add_flag("--divided", arguments->divided,
                    "A wall with two doors between start and goal: a chair and a cart stand in the "
                    "near one, the far one is open");
  command
      ->add_flag("--varied", arguments->varied,
                 "The same with size, doors, start, goal and obstacles drawn at random")
      ->excludes(size);
  command->add_option("--output", arguments->output, "World file to write (.yaml)")->required();
  setWork(*command, run, arguments, generate);
}

}  // namespace casepush
