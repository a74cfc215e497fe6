#include "casepush/lab/task_experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "parallel.h"
#include "push_pool.h"
#include "scratch_case_base.h"

namespace casepush {
namespace {

// Between object or goal and the nearest corner's walls, for the robot to go around.
constexpr double kCornerRoomM = 2.5;
constexpr double kRobotGapM = 0.3;

std::uint64_t seedOf(std::uint64_t seed, int index) {
  return seed * 1000003 + static_cast<std::uint64_t>(index);
}

PushProblem problemOf(const Catalog& catalog, const TaskExperimentOptions& options,
                      std::uint64_t seed) {
  if (options.setting == TaskSetting::kDiagonal) {
    return diagonalProblem(catalog, options.object, options.robot, options.goal_distance_m, seed);
  }
  RoomOptions room;
  room.seed = seed;
  room.size_m = options.room_size_m;
  room.density = options.room_density;
  room.object = options.object;
  room.robot = options.robot;
  WorldModel world = generateRoom(catalog, room);
  const std::string id = world.objects.front().id;
  const Pose2 goal = *world.goal;
  return {std::move(world), id, goal};
}

std::vector<Case> learnCases(const Catalog& catalog, const TaskExperimentOptions& options,
                             int index) {
  LearningOptions learning = options.learning;
  learning.jobs = 1;
  learning.exploration.seed = seedOf(options.seed, index);
  learning.lab.simulator.seed = learning.exploration.seed;
  return learnInScratch(catalog, options.object, options.robot, learning).cases;
}

PushRunResult runTask(const Catalog& catalog, const TaskExperimentOptions& options,
                      const std::vector<Case>& cases, std::uint64_t seed) {
  const PushProblem problem = problemOf(catalog, options, seed);
  PushRunOptions run = options.run;
  run.lab.simulator.seed = seed;
  if (options.load) {
    run.lab.simulator.loads[problem.object_id] = *options.load;
  }
  return runPushTask(catalog, problem, cases, surveyMap(problem.world), run);
}

}  // namespace

void TaskExperimentOptions::validate() const {
  Violations violations;
  violations.require("goal_distance_m", goal_distance_m, 0.5, 50.0);
  violations.require("tasks", tasks, 1, 100000);
  violations.require("case_bases", case_bases, 1, 1000);
  violations.require("jobs", jobs, 1, 256);
  violations.throwIfAny("task experiment");
}

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

std::vector<TaskRun> runTasks(const Catalog& catalog, const TaskExperimentOptions& options,
                              const TaskExperimentProgress& progress) {
  options.validate();
  std::mutex mutex;
  int done = 0;
  const auto tell = [&](const char* what, int count) {
    const std::lock_guard<std::mutex> lock(mutex);
    ++done;
    if (progress) {
      progress(what, done, count);
    }
  };
  std::vector<std::vector<Case>> bases(options.case_bases);
  forEachIndex(options.case_bases, options.jobs, [&](int i) {
    bases[i] = learnCases(catalog, options, i);
    tell("learning", options.case_bases);
  });
  done = 0;
  std::vector<TaskRun> runs(options.tasks);
  forEachIndex(options.tasks, options.jobs, [&](int i) {
    runs[i].seed = seedOf(options.seed, i);
    runs[i].case_base = i % options.case_bases;
    runs[i].result = runTask(catalog, options, bases[runs[i].case_base], runs[i].seed);
    tell("tasks", options.tasks);
  });
  return runs;
}

}  // namespace casepush
