#include "casepush/lab/plan_benchmark.h"

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <map>
#include <memory>
#include <utility>

#include "casepush/common/violations.h"
#include "casepush/lab/push_run.h"
#include "casepush/world/static_map.h"
#include "thread_time.h"

namespace casepush {
namespace {

PushPlannerOptions optionsFor(PlannerKind kind, bool improve) {
  PushPlannerOptions options = PushPlannerOptions::forPlanner(kind);
  if (!improve) {
    options.solutions = 1;
    options.improvement_extensions = 0;
  }
  return options;
}

PlanRun run(const PushPlanner& planner, const PlanRequest& request,
            const std::vector<Case>& cases) {
  const double begin_s = threadSeconds();
  const PlanResult result = planner.plan(request, cases);
  PlanRun run;
  run.cpu_s = threadSeconds() - begin_s;
  run.solved = result.status == PlanStatus::kSolved;
  run.planning_s = result.planning_s;
  run.pushes = static_cast<int>(result.plan.pushes.size());
  run.length_m = result.plan.lengthM();
  run.nodes = result.nodes;
  return run;
}

// All on one map, with the same masks.
std::vector<std::unique_ptr<PushPlanner>> plannersIn(const Catalog& catalog,
                                                     const WorldModel& world,
                                                     const PlanBenchmarkOptions& options) {
  std::map<std::string, ObjectModel> models;
  const auto add = [&](const std::string& name) {
    ObjectModel model = catalog.object(name);
    models.emplace(model.name, model);
  };
  add(options.object);
  for (const ObjectPlacement& placement : world.objects) add(placement.model);
  const PushPlanner first(surveyMap(world), catalog.robot(world.robot), models,
                          PushPlannerOptions());
  std::vector<std::unique_ptr<PushPlanner>> planners;
  for (const PlannerKind kind : options.planners) {
    planners.push_back(first.withOptions(optionsFor(kind, options.improve)));
  }
  return planners;
}

// A tree that grows towards a goal that it never meets comes to all headings.
void makeMasks(const PushPlanner& planner, PlanRequest request, const std::vector<Case>& cases) {
  constexpr double kNever = 1e-9;
  constexpr double kLongest_s = 10.0;
  request.tolerance = {kNever, kNever};
  request.deadline_s = kLongest_s;
  PushPlannerOptions options;
  options.relax = false;
  planner.withOptions(options)->plan(request, cases);
}

/// Without measuring, so that every planner finds the request's scene ready.
void warmUp(const PushPlanner& planner, PlanRequest request, const std::vector<Case>& cases) {
  constexpr double kLongest_s = 0.1;
  request.deadline_s = std::min(request.deadline_s, kLongest_s);
  planner.plan(request, cases);
}

}  // namespace

void PlanBenchmarkOptions::validate() const {
  Violations violations;
  violations.require("problems", problems, 1, 10000);
  violations.require("runs", runs, 1, 1000);
  violations.require("deadline", deadline_s, 0.01, 3600.0);
  violations.require("worlds", static_cast<double>(worlds.size()), 1, 100);
  violations.require("planners", static_cast<double>(planners.size()), 1, 100);
  violations.throwIfAny("plan benchmark");
}

PlanBenchmark comparePlanners(const Catalog& catalog, const std::vector<Case>& cases,
                              const PlanBenchmarkOptions& options,
                              const std::function<void(int)>& progress) {
  options.validate();
  PlanBenchmark benchmark;
  benchmark.planners = options.planners;
  benchmark.runs.resize(options.planners.size());
  int done = 0;
  for (const std::string& name : options.worlds) {
    const WorldModel world = loadWorld(catalog, name);
    const auto planners = plannersIn(catalog, world, options);
    for (int i = 0; i < options.problems; ++i) {
      if (progress) progress(done++);
      const std::uint64_t seed = options.seed * 100000 + static_cast<std::uint64_t>(i);
      const PushProblem problem = randomProblem(catalog, world, options.object, seed);
      PlanRequest request = requestFor(catalog, problem, seed, options.deadline_s);
      if (i == 0) makeMasks(*planners.front(), request, cases);
      for (std::size_t k = 0; k < planners.size(); ++k) {
        request.seed = seed;
        warmUp(*planners[k], request, cases);
        for (int r = 0; r < options.runs; ++r) {
          request.seed = seed + (static_cast<std::uint64_t>(r) << 32);
          PlanRun measured = run(*planners[k], request, cases);
          measured.world = name;
          measured.run = r;
          benchmark.runs[k].push_back(std::move(measured));
        }
      }
    }
  }
  return benchmark;
}

// The order of the lines and their words are those of ompl::tools::Benchmark in version 1.5.2.
void writeOmplLog(const PlanBenchmark& benchmark, const PlanBenchmarkOptions& options,
                  std::int64_t started_s, std::ostream& out) {
  std::string name = options.object;
  for (const std::string& world : options.worlds) name += "_" + world;
  const std::time_t started = started_s;
  std::tm utc{};
  gmtime_r(&started, &utc);
  out << "OMPL version 1.5.2\nExperiment " << name << "\nRunning on casepush\nStarting at "
      << std::put_time(&utc, "%Y-%m-%d %H:%M:%S") << "\n<<<|\nRandom start and goal poses, "
      << options.problems << " in each world, " << options.runs << " runs on each\n|>>>\n"
      << "<<<|\nnot recorded\n|>>>\n"
      << options.seed << " is the random seed\n"
      << options.deadline_s << " seconds per run\n0 MB per run\n"
      << benchmark.runs.front().size() << " runs per planner\n0 seconds spent to collect the data\n"
      << "0 enum types\n"
      << benchmark.planners.size() << " planners\n";
  for (std::size_t k = 0; k < benchmark.planners.size(); ++k) {
    out << "casepush_" << toString(benchmark.planners[k])
        << "\n0 common properties\n5 properties for each run\n"
        << "solved BOOLEAN\ntime REAL\nsolution segments INTEGER\nsolution length REAL\n"
        << "graph states INTEGER\n"
        << benchmark.runs[k].size() << " runs\n";
    for (const PlanRun& each : benchmark.runs[k]) {
      out << (each.solved ? 1 : 0) << "; " << each.planning_s << "; " << each.pushes << "; "
          << each.length_m << "; " << each.nodes << "; \n";
    }
    out << ".\n";
  }
}

}  // namespace casepush
