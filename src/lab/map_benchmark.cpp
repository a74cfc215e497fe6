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

void measureUpdates(const MapBenchmarkOptions& options, Map map, CollisionChecker checker,
                    MapBenchmark* result) {
  Random random = Random::stream(options.building.seed, "map updates");
  std::vector<double> map_s;
  std::vector<double> checker_s;
  const double last_m = options.building.size_m - kBox_m - options.resolution_m;
  for (int i = 0; i < options.updates; ++i) {
    const double x_m = random.uniform(options.resolution_m, last_m);
    const Eigen::Vector2d corner_m(x_m, random.uniform(options.resolution_m, last_m));
    const std::vector<Eigen::Vector3f> points = boxPoints(corner_m, options.resolution_m);
    map_s.push_back(secondsOf([&] { map.addSurvey(points); }));
    const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(options.resolution_m);
    const CollisionChecker::Area area{corner_m - margin_m,
                                      corner_m + Eigen::Vector2d::Constant(kBox_m) + margin_m};
    checker_s.push_back(secondsOf([&] { checker = checker.updated(map, area); }));
  }
  result->update_map_s = quantile(std::move(map_s), 0.5);
  result->update_checker_s = quantile(std::move(checker_s), 0.5);
}

MapBenchmark::Plan measurePlan(const Catalog& catalog, const PushProblem& problem,
                               const std::vector<Case>& cases,
                               const std::shared_ptr<const Map>& map, PlannerKind kind,
                               double deadline_s, double* planner_s) {
  std::unique_ptr<PushPlanner> planner;
  *planner_s = secondsOf([&] {
    planner = std::make_unique<PushPlanner>(map, catalog.robotOf(problem.world),
                                            catalog.objectsIn(problem.world),
                                            PushPlannerOptions::forPlanner(kind));
  });
  const PlanRequest request = requestFor(catalog, problem, 1, deadline_s);
  MapBenchmark::Plan plan;
  plan.planner = kind;
  PlanResult result;
  plan.first_s = secondsOf([&] { result = planner->plan(request, cases); });
  plan.again_s = secondsOf([&] { result = planner->plan(request, cases); });
  plan.solved = result.status == PlanStatus::kSolved;
  plan.explanation = result.explanation;
  plan.pushes = static_cast<int>(result.plan.pushes.size());
  plan.length_m = result.plan.lengthM();
  plan.nodes = result.nodes;
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
    result.plans.push_back(
        measurePlan(catalog, problem, cases, map, kind, options.deadline_s, &result.planner_s));
  }
  return result;
}

}  // namespace casepush
