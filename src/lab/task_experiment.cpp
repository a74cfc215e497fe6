#include "casepush/lab/task_experiment.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "casepush/common/violations.h"
#include "casepush/world/static_map.h"
#include "parallel.h"
#include "scratch_case_base.h"

namespace casepush {
namespace {

std::uint64_t seedOf(std::uint64_t seed, int index) {
  return seed * 1000003 + static_cast<std::uint64_t>(index);
}

/// The object first: its cases are the same whatever else is learnt.
std::vector<std::string> objectsToLearn(const Catalog& catalog,
                                        const TaskExperimentOptions& options) {
  std::vector<std::string> objects = {options.object};
  if (!options.run.clear_obstacles) return objects;
  const auto add = [&](const std::string& object) {
    const bool known = std::any_of(objects.begin(), objects.end(), [&](const std::string& each) {
      return catalog.object(each).name == catalog.object(object).name;
    });
    if (!known) objects.push_back(object);
  };
  for (const std::string& object : options.movable) add(object);
  if (options.setting == TaskSetting::kWorld) {
    for (const ObjectPlacement& other : loadWorld(catalog, options.world).objects) {
      add(other.model);
    }
  }
  return objects;
}

std::vector<Case> learnCases(const Catalog& catalog, const TaskExperimentOptions& options,
                             int index) {
  LearningOptions learning = options.learning;
  learning.jobs = 1;
  learning.exploration.seed = seedOf(options.seed, index);
  learning.lab.simulator.seed = learning.exploration.seed;
  return learnAllInScratch(catalog, objectsToLearn(catalog, options), options.robot, learning);
}

void runTask(const Catalog& catalog, const TaskExperimentOptions& options,
             const std::vector<Case>& cases, TaskRun* task) {
  const PushProblem problem = taskProblem(catalog, options, task->seed);
  const std::shared_ptr<const Map> map = surveyMap(problem.world);
  if (options.plans > 0) {
    task->plans = planTrials(catalog, problem, cases, map, options.run, options.plans, task->seed);
  }
  if (!options.execute) return;
  PushRunOptions run = options.run;
  run.lab.simulator.seed = task->seed;
  if (options.load) {
    run.lab.simulator.loads[problem.object_id] = *options.load;
  }
  task->result = runPushTask(catalog, problem, cases, map, run);
}

}  // namespace

void TaskExperimentOptions::validate() const {
  Violations violations;
  violations.require("goal_distance_m", goal_distance_m, 0.5, 50.0);
  violations.require("tasks", tasks, 1, 100000);
  violations.require("case_bases", case_bases, 1, 1000);
  violations.require("plans", plans, execute ? 0 : 1, 10000);
  violations.require("jobs", jobs, 1, 256);
  violations.throwIfAny("task experiment");
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
    runTask(catalog, options, bases[runs[i].case_base], &runs[i]);
    tell("tasks", options.tasks);
  });
  return runs;
}

}  // namespace casepush
