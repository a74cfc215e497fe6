#include "casepush/lab/coverage_experiment.h"

#include <cmath>
#include <utility>

#include "casepush/execution/displacement_coverage.h"
#include "casepush/lab/push_run.h"
#include "casepush/world/static_map.h"
#include "scratch_case_base.h"

namespace casepush {
namespace {

constexpr double kReachRadiusM = 0.8;
constexpr double kTurnRad = 0.3;
// Generous, so that a busy machine changes nothing.
constexpr double kDeadlineS = 120.0;

struct Learnt {
  std::vector<Case> cases;
  CoverageMeasures measures;
  std::vector<int> plan_pushes;  ///< Per problem; 0: there is no plan.
};

Learnt learnCases(const Catalog& catalog, const CoverageExperimentOptions& options,
                  CoverageStrategy strategy, std::uint64_t seed) {
  LearningOptions learning = options.learning;
  learning.exploration.coverage = strategy;
  learning.exploration.seed = seed;
  learning.lab.simulator.seed = seed;
  ScratchLearning done = learnInScratch(catalog, options.object, options.robot, learning);
  Learnt learnt;
  learnt.cases = std::move(done.cases);
  learnt.measures.pushes = done.result.pushes;
  return learnt;
}

void measureCoverage(Learnt& learnt) {
  std::vector<Pose2> outcomes;
  DisplacementCoverage coverage;
  for (const Case& push_case : learnt.cases) {
    outcomes.push_back(push_case.start_outcome.mean);
    coverage.add(outcomes.back());
    learnt.measures.turning_cases += std::abs(outcomes.back().yaw()) > kTurnRad ? 1.0 : 0.0;
  }
  learnt.measures.mean_distance = coverage.meanDistance();
  learnt.measures.reach_2 = reachableShare(outcomes, 2, kReachRadiusM);
  learnt.measures.reach_3 = reachableShare(outcomes, 3, kReachRadiusM);
}

void planProblems(const Catalog& catalog, const CoverageExperimentOptions& options,
                  const WorldModel& world, std::uint64_t seed, std::vector<Learnt*> all) {
  const std::shared_ptr<const Map> map = surveyMap(world);
  for (int i = 0; i < options.problems; ++i) {
    const std::uint64_t problem_seed = seed * 1000003 + static_cast<std::uint64_t>(i);
    const PushProblem problem = randomProblem(catalog, world, options.object, problem_seed);
    const PushPlanner planner(map, catalog.robot(options.robot), catalog.objectsIn(problem.world),
                              PushPlannerOptions{});
    const PlanRequest request = requestFor(catalog, problem, problem_seed, kDeadlineS);
    for (Learnt* learnt : all) {
      const PlanResult plan = planner.plan(request, learnt->cases);
      const bool solved = plan.status == PlanStatus::kSolved;
      learnt->plan_pushes.push_back(solved ? static_cast<int>(plan.plan.pushes.size()) : 0);
      learnt->measures.planned += solved ? 1.0 / options.problems : 0.0;
    }
  }
}

/// Compared on the problems that both solve: else the better one would count its harder ones.
void averagePlans(Learnt& a, Learnt& b) {
  double count = 0.0;
  for (std::size_t i = 0; i < a.plan_pushes.size(); ++i) {
    if (a.plan_pushes[i] > 0 && b.plan_pushes[i] > 0) {
      a.measures.plan_pushes += a.plan_pushes[i];
      b.measures.plan_pushes += b.plan_pushes[i];
      count += 1.0;
    }
  }
  a.measures.plan_pushes /= std::max(1.0, count);
  b.measures.plan_pushes /= std::max(1.0, count);
}

}  // namespace

CoverageExperimentResult coverageExperiment(
    const Catalog& catalog, const CoverageExperimentOptions& options,
    const std::function<void(const std::string&)>& progress) {
  WorldModel world = loadWorld(catalog, options.world);
  world.robot = options.robot;
  CoverageExperimentResult result;
  for (int i = 0; i < options.seeds; ++i) {
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(i);
    const std::string number = "seed " + std::to_string(seed) + ": ";
    const auto tell = [&](const std::string& what) {
      if (progress) {
        progress(number + what);
      }
    };
    tell("learning at random");
    Learnt random = learnCases(catalog, options, CoverageStrategy::kRandom, seed);
    tell("learning spread");
    Learnt spread = learnCases(catalog, options, CoverageStrategy::kSpread, seed);
    measureCoverage(random);
    measureCoverage(spread);
    tell("planning");
    planProblems(catalog, options, world, seed, {&random, &spread});
    averagePlans(random, spread);
    result.random.push_back(random.measures);
    result.spread.push_back(spread.measures);
  }
  return result;
}

}  // namespace casepush
