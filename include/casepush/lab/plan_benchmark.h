#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/catalog.h"
#include "casepush/planning/planner_kind.h"

namespace casepush {

struct PlanBenchmarkOptions {
  std::string object = "office_chair";
  std::vector<std::string> worlds = {"office"};
  std::vector<PlannerKind> planners = allPlannerKinds();
  int problems = 30;         ///< In each world.
  int runs = 1;              ///< Of each planner on each problem, each with another seed.
  double deadline_s = 10.0;  ///< For each plan.
  bool improve = false;      ///< Let planners go on after their first solution.
  std::uint64_t seed = 1;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// One planner on one problem.
struct PlanRun {
  std::string world;
  int run = 0;  ///< 0: the first on its problem.
  bool solved = false;
  double planning_s = 0.0;  ///< Wall time of the whole call, the robot's paths included.
  double cpu_s = 0.0;       ///< CPU time of the same: on a busy machine wall time says little.
  int pushes = 0;
  double length_m = 0.0;
  int nodes = 0;
};

struct PlanBenchmark {
  std::vector<PlannerKind> planners;
  std::vector<std::vector<PlanRun>> runs;  ///< Of each planner: all of a problem, then the next.
};

/// In each world random problems that a robot that drives could solve, each given to every planner
/// in turn. Masks, which all planners share, are made beforehand; before its first run on a problem
/// each planner is called once without measuring, for at most a tenth of a second.
/// @param cases  Of the object, learnt by the world's robot.
/// @param progress  Called with the number of finished problems.
/// @throws InputError from the catalog, the world or validate().
PlanBenchmark comparePlanners(const Catalog& catalog, const std::vector<Case>& cases,
                              const PlanBenchmarkOptions& options,
                              const std::function<void(int)>& progress = {});

/// In the format of OMPL's benchmark logs, which `ompl_benchmark_statistics.py` and Planner Arena
/// read.
/// @param started_s  When the benchmark began, in seconds since 1970.
void writeOmplLog(const PlanBenchmark& benchmark, const PlanBenchmarkOptions& options,
                  std::int64_t started_s, std::ostream& out);

}  // namespace casepush
