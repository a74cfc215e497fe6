#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "casepush/lab/learning.h"
#include "casepush/lab/plan_trials.h"
#include "casepush/lab/push_run.h"

namespace casepush {

/// Where the tasks of an experiment are set.
enum class TaskSetting {
  kRandomRooms,   ///< Each task in a cluttered room of its own, see generateRoom().
  kDividedRooms,  ///< Each in a room of its own with two doors, see generateDividedRoom().
  kVariedRooms,   ///< The same, with measures and obstacles drawn, see drawDividedRoom().
  kWorld,         ///< From and to random places in a world, see randomProblem().
  kDiagonal,  ///< On an open floor, the goal at a fixed distance diagonally; headings at random.
};

struct TaskExperimentOptions {
  std::string object = "office_chair";
  std::string robot = "cobot";
  TaskSetting setting = TaskSetting::kRandomRooms;
  double room_size_m = 10.0;     ///< Of rooms: edge length, and
  double room_density = 0.1;     ///< share of the floor under furniture.
  double goal_distance_m = 4.0;  ///< Of kDiagonal.
  std::string world;             ///< Of kWorld: name or YAML file.
  /// Other objects, by name or URDF file: of kRandomRooms among the furniture, of kDividedRooms in
  /// the near door, of kVariedRooms those to draw from. Where obstacles are cleared
  /// (PushRunOptions), they are learnt, too, and so are those of a world.
  std::vector<std::string> movable;
  int tasks = 20;
  int case_bases = 4;  ///< Learnt anew, each with a seed of its own; tasks take turns.
  std::uint64_t seed = 1;
  LearningOptions learning;
  PushRunOptions run;
  int plans = 0;             ///< Made for each task beforehand, to be compared; see planTrials().
  bool execute = true;       ///< False: nothing but those plans.
  std::optional<Load> load;  ///< On the object during the tasks, whatever it was learnt with.
  int jobs = 1;              ///< Threads; the result does not depend on their number.

  void validate() const;  ///< @throws InputError listing every violation.
};

/// One task of an experiment.
struct TaskRun {
  std::uint64_t seed = 0;
  int case_base = 0;  ///< From 0.
  std::vector<PlanTrial> plans;
  PushRunResult result;  ///< As it is by default if nothing was executed.
};

using TaskExperimentProgress = std::function<void(const char* what, int done, int count)>;

/// A push problem of kDiagonal: an empty square room with walls, object and goal half of the
/// distance from its middle.
PushProblem diagonalProblem(const Catalog& catalog, const std::string& object,
                            const std::string& robot, double distance_m, std::uint64_t seed);

/// The problem of one task, by its seed. @throws InputError from the catalog, rooms and worlds.
PushProblem taskProblem(const Catalog& catalog, const TaskExperimentOptions& options,
                        std::uint64_t seed);

/// Learns and runs the tasks, each from its own seed: experiments with the same seed, object and
/// setting run the same problems.
/// @param progress  Told what is being done, and how many of how many are done; called by several
///   threads, but by one at a time.
/// @throws InputError from catalog, learning and rooms.
std::vector<TaskRun> runTasks(const Catalog& catalog, const TaskExperimentOptions& options,
                              const TaskExperimentProgress& progress = {});

}  // namespace casepush
