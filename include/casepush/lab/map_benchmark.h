#pragma once

#include <functional>
#include <string>
#include <vector>

#include "casepush/lab/building_generator.h"
#include "casepush/model/case.h"
#include "casepush/planning/planner_kind.h"
#include "casepush/world/map_file.h"

namespace casepush {

struct MapBenchmarkOptions {
  BuildingOptions building;
  double resolution_m = 0.05;
  std::vector<PlannerKind> planners = {PlannerKind::kExpRrt, PlannerKind::kLattice};
  double deadline_s = 30.0;  ///< Wall time for each plan.
  int updates = 20;          ///< Changes of a box of 1 m x 1 m x 1 m.
};

/// Times are wall seconds.
struct MapBenchmark {
  MapSize size;
  double file_mb = 0.0;   ///< As a .bt file.
  double survey_s = 0.0;  ///< Making the OctoMap of the building.
  double save_s = 0.0;
  double load_s = 0.0;
  double checker_s = 0.0;         ///< Columns of the whole map.
  double update_map_s = 0.0;      ///< Medians over the updates: OctoMap,
  double update_checker_s = 0.0;  ///< and columns.

  struct Plan {
    PlannerKind planner = PlannerKind::kExpRrt;
    double made_s = 0.0;  ///< A planner for one object, before its first plan.
    bool solved = false;
    std::string explanation;
    double first_s = 0.0;  ///< The first call of a new planner.
    double again_s = 0.0;  ///< The same request once more.
    /// After a box of 1 m appeared: following the change if it is told where (median), and if it
    /// has to compare the maps; then the same request.
    double update_told_s = 0.0;
    double update_compared_s = 0.0;
    double updated_first_s = 0.0;
    int pushes = 0;
    double length_m = 0.0;
    int nodes = 0;
  };
  std::vector<Plan> plans;  ///< From corner to corner of the building.
};

/// Measures what a large map costs. @throws InputError from the generator and the map.
/// @param progress  Told what is being measured.
MapBenchmark measureMap(const Catalog& catalog, const std::vector<Case>& cases,
                        const MapBenchmarkOptions& options,
                        const std::function<void(const std::string&)>& progress);

}  // namespace casepush
