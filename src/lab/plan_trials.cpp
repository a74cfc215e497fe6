#include "casepush/lab/plan_trials.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "thread_time.h"

namespace casepush {
namespace {

PlanRequest requestOf(const Catalog& catalog, const PushProblem& problem,
                      const std::vector<Case>& cases, const PushRunOptions& options) {
  PlanRequest request = requestFor(catalog, problem, 0, options.task.plan_deadline_s);
  if (!options.clear_obstacles) return request;
  std::vector<PlacedObject>& obstacles = request.obstacles;
  const auto is_movable = [&](const PlacedObject& object) {
    return std::any_of(cases.begin(), cases.end(), [&](const Case& each) {
      return isFor(each, object.model, problem.world.robot);
    });
  };
  obstacles.erase(std::remove_if(obstacles.begin(), obstacles.end(), is_movable), obstacles.end());
  return request;
}

}  // namespace

std::vector<PlanTrial> planTrials(const Catalog& catalog, const PushProblem& problem,
                                  const std::vector<Case>& cases, std::shared_ptr<const Map> map,
                                  const PushRunOptions& options, int count, std::uint64_t seed) {
  const PushPlanner planner(std::move(map), catalog.robotOf(problem.world),
                            catalog.objectsIn(problem.world), options.planner);
  PlanRequest request = requestOf(catalog, problem, cases, options);
  std::vector<PlanTrial> trials;
  for (int i = -1; i < count; ++i) {
    request.seed = seed + static_cast<std::uint64_t>(i + 1);
    const double begin_s = threadSeconds();
    const PlanResult result = planner.plan(request, cases);
    const double planning_s = threadSeconds() - begin_s;
    if (i < 0) continue;
    const bool is_solved = result.status == PlanStatus::kSolved;
    trials.push_back({is_solved, result.plan.lengthM(), result.expected_s,
                      static_cast<int>(result.plan.pushes.size()), result.nodes, planning_s});
  }
  return trials;
}

double shortestM(const std::vector<PlanTrial>& plans) {
  double shortest_m = std::numeric_limits<double>::infinity();
  for (const PlanTrial& each : plans) {
    if (each.is_solved) shortest_m = std::min(shortest_m, each.length_m);
  }
  return shortest_m;
}

}  // namespace casepush
