#include "casepush/lab/map_benchmark.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include "casepush/common/random.h"
#include "casepush/common/scratch_folder.h"
#include "casepush/lab/push_run.h"
#include "casepush/lab/quantile.h"
#include "casepush/world/collision_checker.h"

namespace casepush {
namespace {

constexpr double kMegabyte = 1e6;
constexpr double kBox_m = 1.0;

template <typename Action>
double secondsOf(const Action& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The centres of all cells of a box that appears on the floor.
std::vector<Eigen::Vector3f> boxPoints(const Eigen::Vector2d& corner_m, double resolution_m) {
  std::vector<Eigen::Vector3f> points;
  const int cells = static_cast<int>(kBox_m / resolution_m);
  for (int x = 0; x < cells; ++x) {
    for (int y = 0; y < cells; ++y) {
      for (int z = 0; z < cells; ++z) {
        const Eigen::Vector3d offset_m = (Eigen::Vector3d(x, y, z).array() + 0.5) * resolution_m;
        points.push_back(
            (Eigen::Vector3d(corner_m.x(), corner_m.y(), 0.0) + offset_m).cast<float>());
      }
    }
  }
  return points;
}

/// Puts a box somewhere and returns where.
CollisionChecker::Area addBox(const MapBenchmarkOptions& options, Random* random, Map* map,
                              double* seconds) {
  const double last_m = options.building.size_m - kBox_m - options.resolution_m;
  const double x_m = random->uniform(options.resolution_m, last_m);
  const Eigen::Vector2d corner_m(x_m, random->uniform(options.resolution_m, last_m));
  const std::vector<Eigen::Vector3f> points = boxPoints(corner_m, options.resolution_m);
  *seconds = secondsOf([&] { map->addSurvey(points); });
  const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(options.resolution_m);
  return {corner_m - margin_m, corner_m + Eigen::Vector2d::Constant(kBox_m) + margin_m};
}

void measureUpdates(const MapBenchmarkOptions& options, Map map, CollisionChecker checker,
                    MapBenchmark* result) {
  Random random = Random::stream(options.building.seed, "map updates");
  std::vector<double> map_s(options.updates);
  std::vector<double> checker_s;
  for (double& seconds : map_s) {
    const CollisionChecker::Area area = addBox(options, &random, &map, &seconds);
    checker_s.push_back(secondsOf([&] { checker = checker.updated(map, area); }));
  }
  result->update_map_s = quantile(std::move(map_s), 0.5);
  result->update_checker_s = quantile(std::move(checker_s), 0.5);
}

/// Lets boxes appear on the planner's map, and plans once more after the first one.
void measurePlannerUpdates(const MapBenchmarkOptions& options, const PlanRequest& request,
                           const std::vector<Case>& cases, const PushPlanner& before,
                           MapBenchmark::Plan* plan) {
  Random random = Random::stream(options.building.seed, "planner updates");
  std::vector<double> told_s;
  std::vector<double> compared_s;
  for (int i = 0; i < options.updates; ++i) {
    Map map = before.map()->copy();
    double unused_s = 0.0;
    const CollisionChecker::Area area = addBox(options, &random, &map, &unused_s);
    const auto newer = std::make_shared<const Map>(std::move(map));
    std::unique_ptr<PushPlanner> planner;
    compared_s.push_back(secondsOf([&] { planner = before.updated(newer); }));
    told_s.push_back(secondsOf([&] { planner = before.updated(newer, area); }));
    if (i > 0) continue;
    plan->updated_first_s = secondsOf([&] { planner->plan(request, cases); });
  }
  plan->update_told_s = quantile(std::move(told_s), 0.5);
  plan->update_compared_s = quantile(std::move(compared_s), 0.5);
}

MapBenchmark::Plan measurePlan(const Catalog& catalog, const PushProblem& problem,
                               const std::vector<Case>& cases,
                               const std::shared_ptr<const Map>& map, PlannerKind kind,
                               const MapBenchmarkOptions& options) {
  MapBenchmark::Plan plan;
  plan.planner = kind;
  std::unique_ptr<PushPlanner> planner;
  plan.made_s = secondsOf([&] {
    planner = std::make_unique<PushPlanner>(map, catalog.robotOf(problem.world),
                                            catalog.objectsIn(problem.world),
                                            PushPlannerOptions::forPlanner(kind));
  });
  const PlanRequest request = requestFor(catalog, problem, 1, options.deadline_s);
  PlanResult result;
  plan.first_s = secondsOf([&] { result = planner->plan(request, cases); });
  plan.again_s = secondsOf([&] { result = planner->plan(request, cases); });
  plan.solved = result.status == PlanStatus::kSolved;
  plan.explanation = result.explanation;
  plan.pushes = static_cast<int>(result.plan.pushes.size());
  plan.length_m = result.plan.lengthM();
  plan.nodes = result.nodes;
  measurePlannerUpdates(options, request, cases, *planner, &plan);
  return plan;
}

}  // namespace

MapBenchmark measureMap(const Catalog& catalog, const std::vector<Case>& cases,
                        const MapBenchmarkOptions& options,
                        const std::function<void(const std::string&)>& progress) {
  MapBenchmark result;
  progress("building");
  const WorldModel world = generateBuilding(catalog, options.building);
  auto map = std::make_shared<Map>(options.resolution_m);
  progress("map");
  result.survey_s = secondsOf([&] { map->addSurvey(surveyPoints(world, options.resolution_m)); });
  result.size = sizeOf(*map);
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "building.bt";
  result.save_s = secondsOf([&] { map->save(file); });
  result.file_mb = static_cast<double>(std::filesystem::file_size(file)) / kMegabyte;
  result.load_s = secondsOf([&] { Map::load(file); });
  std::unique_ptr<CollisionChecker> checker;
  result.checker_s = secondsOf([&] { checker = std::make_unique<CollisionChecker>(*map); });
  progress("updates");
  measureUpdates(options, map->copy(), *checker, &result);
  const PushProblem problem{world, world.objects.front().id, *world.goal};
  for (const PlannerKind kind : options.planners) {
    progress(toString(kind));
    result.plans.push_back(measurePlan(catalog, problem, cases, map, kind, options));
  }
  return result;
}

}  // namespace casepush
