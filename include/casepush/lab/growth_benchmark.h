#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "casepush/model/case.h"
#include "casepush/model/catalog.h"
#include "casepush/planning/planner_kind.h"

namespace casepush {

struct GrowthBenchmarkOptions {
  std::string object = "office_chair";
  std::string world = "office";
  std::vector<int> nodes = {1000, 10000, 50000};    ///< Sizes of the trees.
  std::vector<int> case_counts = {5, 14, 50, 100};  ///< Sizes of the sets of cases.
  std::vector<PlannerKind> deadline_planners = allPlannerKinds();
  std::vector<double> deadlines_s = {0.001, 0.05, 1.0};
  int many_cases = 10000;  ///< For the deadlines, besides the given cases.
  int problems = 8;        ///< Random ones, over which medians are taken.
  std::uint64_t seed = 1;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// Times are CPU time of the thread, which other work on the machine changes least; lateness is
/// wall time.
struct GrowthBenchmark {
  /// Whole calls of the planner that grow a tree towards a goal that it never meets.
  struct Tree {
    int cases = 0;
    int nodes = 0;              ///< What was grown at least; fewer than asked if nothing was left.
    double median_cpu_s = 0.0;  ///< Of a call.
    double max_cpu_s = 0.0;
    double per_node_us = 0.0;  ///< Median.
  };
  /// First plans with so many cases.
  struct First {
    int cases = 0;
    int solved = 0;
    double median_cpu_s = 0.0;
    double max_cpu_s = 0.0;
  };
  /// A goal that is never met: how late do calls return?
  struct Late {
    PlannerKind planner = PlannerKind::kExpRrt;
    double deadline_s = 0.0;
    int cases = 0;
    double late_s = 0.0;  ///< Negative if before the deadline.
    int nodes = 0;
  };
  std::vector<Tree> by_nodes;  ///< With the given cases.
  std::vector<Tree> by_cases;  ///< Trees of the second of GrowthBenchmarkOptions::nodes.
  std::vector<First> first;
  std::vector<Late> late;
};

/// The given cases, and then copies of them turned about the object by random angles: as many as
/// asked for. Their speed is meant to be measured, not their truth.
std::vector<Case> turnedCases(const std::vector<Case>& cases, int count, std::uint64_t seed);

/// Measures how fast Exp-RRT grows, and whether planners keep their deadlines.
/// @throws InputError from the catalog, the world or validate(), or if there are no cases.
/// @param progress  Told what is being measured.
GrowthBenchmark measureGrowth(const Catalog& catalog, const std::vector<Case>& cases,
                              const GrowthBenchmarkOptions& options,
                              const std::function<void(const std::string&)>& progress);

}  // namespace casepush
