// Where the tasks of an experiment are set.
#include <cmath>
#include <utility>

#include "casepush/common/random.h"
#include "casepush/lab/divided_room.h"
#include "casepush/lab/room_generator.h"
#include "casepush/lab/task_experiment.h"
#include "casepush/world/static_map.h"
#include "push_pool.h"

namespace casepush {
namespace {

// Between object or goal and the nearest corner's walls, for the robot to go around.
constexpr double kCornerRoomM = 2.5;
constexpr double kRobotGapM = 0.3;

PushProblem problemIn(WorldModel world) {
  const std::string id = world.objects.front().id;
  const Pose2 goal = *world.goal;
  return {std::move(world), id, goal};
}

template <typename RoomKind>
RoomKind roomOptions(const TaskExperimentOptions& options, std::uint64_t seed) {
  RoomKind room;
  room.seed = seed;
  room.size_m = options.room_size_m;
  room.density = options.room_density;
  room.object = options.object;
  room.robot = options.robot;
  room.movable = options.movable;
  return room;
}

}  // namespace

PushProblem diagonalProblem(const Catalog& catalog, const std::string& object,
                            const std::string& robot, double distance_m, std::uint64_t seed) {
  const ObjectModel model = catalog.object(object);
  const double corner_m = 0.5 * distance_m * std::sqrt(0.5);
  const double half_m = corner_m + kCornerRoomM + model.radius_m;
  Random random = Random::stream(seed, "diagonal problem");
  const Pose2 start(-corner_m, -corner_m, random.uniform(-M_PI, M_PI));
  const double away_m = model.radius_m + catalog.robot(robot).radius_m + kRobotGapM;
  PushProblem problem;
  problem.object_id = model.name + "_1";
  problem.world.name = "open_floor";
  problem.world.min_m = {-half_m, -half_m};
  problem.world.max_m = {half_m, half_m};
  problem.world.robot = robot;
  problem.world.map_T_robot =
      start * Pose2(0.0, 0.0, random.uniform(-M_PI, M_PI)) * Pose2(-away_m, 0.0, 0.0);
  problem.world.objects.push_back({problem.object_id, object, start, 0});
  problem.map_T_goal = Pose2(corner_m, corner_m, random.uniform(-M_PI, M_PI));
  addWalls(problem.world, half_m);
  return problem;
}

PushProblem taskProblem(const Catalog& catalog, const TaskExperimentOptions& options,
                        std::uint64_t seed) {
  switch (options.setting) {
    case TaskSetting::kRandomRooms:
      return problemIn(generateRoom(catalog, roomOptions<RoomOptions>(options, seed)));
    case TaskSetting::kDividedRooms:
      return problemIn(
          generateDividedRoom(catalog, roomOptions<DividedRoomOptions>(options, seed)));
    case TaskSetting::kVariedRooms:
      return problemIn(generateDividedRoom(
          catalog, drawDividedRoom(catalog, roomOptions<DividedRoomOptions>(options, seed))));
    case TaskSetting::kWorld:
      return randomProblem(catalog, loadWorld(catalog, options.world), options.object, seed);
    case TaskSetting::kDiagonal:
      break;
  }
  return diagonalProblem(catalog, options.object, options.robot, options.goal_distance_m, seed);
}

}  // namespace casepush
