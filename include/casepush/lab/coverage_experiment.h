#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "casepush/lab/learning.h"

namespace casepush {

struct CoverageExperimentOptions {
  std::string object = "office_chair";
  std::string robot = "cobot";
  std::string world = "office";  ///< Where problems are set.
  int seeds = 5;                 ///< Case bases learnt per strategy.
  int problems = 20;             ///< Random push problems planned with each.
  std::uint64_t seed = 1;        ///< First of them.
  LearningOptions learning;
};

/// What the cases learnt with one seed are good for.
struct CoverageMeasures {
  double pushes = 0.0;         ///< Executed in learning.
  double mean_distance = 0.0;  ///< DisplacementCoverage::meanDistance, in goal tolerances.
  double reach_2 = 0.0;        ///< reachableShare within 0.8 m by at most two pushes,
  double reach_3 = 0.0;        ///< and by at most three.
  double turning_cases = 0.0;  ///< Cases that turn the object by more than 0.3 rad.
  double planned = 0.0;        ///< Share of the problems for which there is a plan.
  double plan_pushes = 0.0;    ///< Mean number of pushes of the plans of problems that all the case
                               ///< bases of this seed solve.
};

/// The strategies' measures, seed by seed: measures[strategy][i] belong to seed + i.
struct CoverageExperimentResult {
  std::vector<CoverageMeasures> random;
  std::vector<CoverageMeasures> spread;
};

/// Learns with both strategies and plans the same random problems with what they learnt.
/// @param progress  Told what is being done.
/// @throws InputError as learnInLab and randomProblem; also if learning gives up.
CoverageExperimentResult coverageExperiment(
    const Catalog& catalog, const CoverageExperimentOptions& options,
    const std::function<void(const std::string&)>& progress = {});

}  // namespace casepush
