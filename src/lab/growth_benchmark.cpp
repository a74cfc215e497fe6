#include "casepush/lab/growth_benchmark.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include "casepush/common/input_error.h"
#include "casepush/common/random.h"
#include "casepush/common/violations.h"
#include "casepush/lab/push_run.h"
#include "casepush/lab/quantile.h"
#include "casepush/world/static_map.h"
#include "thread_time.h"

namespace casepush {
namespace {

// So long that it never cuts a measurement off.
constexpr double kPatience_s = 60.0;

/// Motion `a_T_b` of the object, seen by somebody who stands turned by `angle_rad`.
Pose2 turned(double angle_rad, const Pose2& a_T_b) {
  return Pose2(0.0, 0.0, angle_rad) * a_T_b * Pose2(0.0, 0.0, -angle_rad);
}

PoseGaussian turned(double angle_rad, const PoseGaussian& gaussian) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  const Eigen::Matrix3d covariance = turn * gaussian.covariance * turn.transpose();
  return {turned(angle_rad, gaussian.mean), 0.5 * (covariance + covariance.transpose())};
}

Case turned(double angle_rad, Case push_case) {
  for (CaseStep& step : push_case.steps) {
    step.object_T_robot = Pose2(0.0, 0.0, angle_rad) * step.object_T_robot;
    step.start_T_object = turned(angle_rad, step.start_T_object);
  }
  for (PoseGaussian& along : push_case.tube) along = turned(angle_rad, along);
  push_case.start_outcome = turned(angle_rad, push_case.start_outcome);
  return push_case;
}

/// The world's map and the problems in it.
class Bench {
 public:
  Bench(const Catalog& catalog, const GrowthBenchmarkOptions& options)
      : catalog_(catalog),
        options_(options),
        world_(loadWorld(catalog, options.world)),
        map_(surveyMap(world_)) {
    for (int i = 0; i < options.problems; ++i) {
      const std::uint64_t seed = options.seed * 100000 + static_cast<std::uint64_t>(i);
      const PushProblem problem = randomProblem(catalog, world_, options.object, seed);
      requests_.push_back(requestFor(catalog, problem, seed, kPatience_s));
    }
    models_.emplace(options.object, catalog.object(options.object));
    for (const PlanRequest& request : requests_) {
      for (const PlacedObject& obstacle : request.obstacles) {
        models_.emplace(obstacle.model, catalog.object(obstacle.model));
      }
      models_.emplace(request.object.model, catalog.object(request.object.model));
    }
  }

  std::unique_ptr<PushPlanner> planner(PlannerKind kind, int max_nodes) const {
    PushPlannerOptions options = PushPlannerOptions::forPlanner(kind);
    options.max_nodes = max_nodes;
    options.solutions = 1;
    options.improvement_extensions = 0;
    options.relax = false;
    return std::make_unique<PushPlanner>(map_, catalog_.robot(world_.robot), models_, options);
  }

  const std::vector<PlanRequest>& requests() const { return requests_; }

  /// The requests with a goal that no push meets.
  std::vector<PlanRequest> missed() const {
    constexpr double kNever = 1e-9;
    std::vector<PlanRequest> missed = requests_;
    for (PlanRequest& request : missed) request.tolerance = {kNever, kNever};
    return missed;
  }

  GrowthBenchmark::Tree tree(const std::vector<Case>& cases, int nodes) const {
    const auto planner = this->planner(PlannerKind::kExpRrt, nodes);
    GrowthBenchmark::Tree tree;
    tree.cases = static_cast<int>(cases.size());
    tree.nodes = nodes;
    std::vector<double> times_s;
    std::vector<double> per_node_us;
    for (const PlanRequest& request : missed()) {
      planner->plan(request, cases);  // Makes the masks.
      const double begin_s = threadSeconds();
      const PlanResult result = planner->plan(request, cases);
      tree.nodes = std::min(tree.nodes, result.nodes);
      times_s.push_back(threadSeconds() - begin_s);
      per_node_us.push_back(1e6 * times_s.back() / std::max(1, result.nodes));
    }
    tree.median_cpu_s = quantile(times_s, 0.5);
    tree.max_cpu_s = quantile(times_s, 1.0);
    tree.per_node_us = quantile(per_node_us, 0.5);
    return tree;
  }

  GrowthBenchmark::First first(const std::vector<Case>& cases) const {
    const auto planner = this->planner(PlannerKind::kExpRrt, PushPlannerOptions().max_nodes);
    GrowthBenchmark::First first;
    first.cases = static_cast<int>(cases.size());
    std::vector<double> times_s;
    for (const PlanRequest& request : requests_) {
      planner->plan(request, cases);  // Makes the masks.
      const double begin_s = threadSeconds();
      const PlanResult result = planner->plan(request, cases);
      first.solved += result.status == PlanStatus::kSolved ? 1 : 0;
      times_s.push_back(threadSeconds() - begin_s);
    }
    first.median_cpu_s = quantile(times_s, 0.5);
    first.max_cpu_s = quantile(times_s, 1.0);
    return first;
  }

  GrowthBenchmark::Late late(PlannerKind kind, double deadline_s,
                             const std::vector<Case>& cases) const {
    constexpr int kNoBound = 10000000;
    const auto planner = this->planner(kind, kNoBound);
    PlanRequest request = missed().front();
    request.deadline_s = deadline_s;
    const PlanResult result = planner->plan(request, cases);
    return {kind, deadline_s, static_cast<int>(cases.size()), result.planning_s - deadline_s,
            result.nodes};
  }

 private:
  const Catalog& catalog_;
  const GrowthBenchmarkOptions& options_;
  WorldModel world_;
  std::shared_ptr<const Map> map_;
  std::map<std::string, ObjectModel> models_;
  std::vector<PlanRequest> requests_;
};

}  // namespace

void GrowthBenchmarkOptions::validate() const {
  Violations violations;
  violations.require("problems", problems, 1, 10000);
  violations.require("nodes", static_cast<double>(nodes.size()), 1, 100);
  for (const int size : nodes) violations.require("nodes", size, 1, 10000000);
  for (const int count : case_counts) violations.require("cases", count, 1, 10000);
  violations.require("many_cases", many_cases, 1, 100000);
  for (const double deadline_s : deadlines_s) {
    violations.require("deadlines", deadline_s, 1e-4, 3600.0);
  }
  violations.throwIfAny("growth benchmark");
}

std::vector<Case> turnedCases(const std::vector<Case>& cases, int count, std::uint64_t seed) {
  Random random = Random::stream(seed, "turned cases");
  std::vector<Case> result;
  for (int i = 0; i < count; ++i) {
    const Case& original = cases[static_cast<std::size_t>(i) % cases.size()];
    const bool is_copy = static_cast<std::size_t>(i) >= cases.size();
    result.push_back(is_copy ? turned(random.uniform(-M_PI, M_PI), original) : original);
    result.back().id = i + 1;
  }
  return result;
}

GrowthBenchmark measureGrowth(const Catalog& catalog, const std::vector<Case>& cases,
                              const GrowthBenchmarkOptions& options,
                              const std::function<void(const std::string&)>& progress) {
  options.validate();
  if (cases.empty()) {
    throw InputError("growth benchmark", "there are no cases of \"" + options.object + "\"");
  }
  const Bench bench(catalog, options);
  GrowthBenchmark result;
  for (const int nodes : options.nodes) {
    progress("tree of " + std::to_string(nodes) + " nodes");
    result.by_nodes.push_back(bench.tree(cases, nodes));
  }
  const int nodes = options.nodes[std::min<std::size_t>(1, options.nodes.size() - 1)];
  for (const int count : options.case_counts) {
    progress("plans with " + std::to_string(count) + " cases");
    const std::vector<Case> turned = turnedCases(cases, count, options.seed);
    result.by_cases.push_back(bench.tree(turned, nodes));
    result.first.push_back(bench.first(turned));
  }
  const std::vector<Case> many = turnedCases(cases, options.many_cases, options.seed);
  for (const PlannerKind kind : options.deadline_planners) {
    progress(std::string("deadlines of ") + toString(kind));
    for (const double deadline_s : options.deadlines_s) {
      result.late.push_back(bench.late(kind, deadline_s, cases));
      result.late.push_back(bench.late(kind, deadline_s, many));
    }
  }
  return result;
}

}  // namespace casepush
