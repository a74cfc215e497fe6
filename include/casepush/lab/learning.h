#pragma once

#include <functional>
#include <optional>
#include <string>

#include "casepush/cases/case_base.h"
#include "casepush/execution/exploration.h"
#include "casepush/lab/closed_loop.h"

namespace casepush {

struct LearningOptions {
  ExplorationOptions exploration;
  ExecutePushOptions push;
  CovarianceFloor floor;
  LabOptions lab;
  std::optional<Load> load;  ///< What the object carries.
};

/// Where learning stands, for a progress line.
struct LearningProgress {
  int case_number = 0;
  int cases = 0;
  int practice_number = 0;
  int practices = 0;
  int pushes = 0;
  int discarded = 0;
};

struct LearningResult {
  bool success = false;
  std::string explanation;
  int pushes = 0;     ///< Executed in all.
  int discarded = 0;  ///< Of these without use.
  int dropped = 0;    ///< Cases replaced because they were too uncertain.
  double sim_time_s = 0.0;
};

/// Learns an object from scratch, or goes on where an earlier run stopped, on an open floor in the
/// simulator, which puts object and robot back after each push. Each finished push is in the case
/// base before the next begins.
/// @param progress  Called before each push; returning false stops, keeping what is finished.
LearningResult learnInLab(const Catalog& catalog, const std::string& object,
                          const std::string& robot, CaseBase& case_base,
                          const LearningOptions& options,
                          const std::function<bool(const LearningProgress&)>& progress = {});

}  // namespace casepush
