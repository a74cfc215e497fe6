#pragma once

#include <functional>
#include <optional>
#include <string>

#include "casepush/cases/case_base.h"
#include "casepush/execution/exploration.h"
#include "casepush/lab/closed_loop.h"

namespace casepush {

/// How object and robot get to where the next push starts.
enum class LabReset {
  kPlace,  ///< The simulator puts them there, on an open floor: fast.
  kDrive,  ///< The robot drives around the object in a walled room; nothing is ever put anywhere.
};

struct LearningOptions {
  ExplorationOptions exploration;
  ExecutePushOptions push;
  CovarianceFloor floor;
  LabOptions lab;
  std::optional<Load> load;  ///< What the object carries.
  LabReset reset = LabReset::kPlace;
  std::optional<WorldModel> room;  ///< For kDrive, with one object; default: 10 x 10 m with walls.
  int jobs = 1;                    ///< Threads for kPlace; the result is the same for any number.
};

/// Where learning stands, for a progress line.
struct LearningProgress {
  int case_number = 0;
  int cases = 0;
  int practice_number = 0;
  int practices = 0;
  int pushes = 0;
  int discarded = 0;
  int done = 0;  ///< Of cases x practices.
};

struct LearningResult {
  bool success = false;
  std::string explanation;
  int pushes = 0;        ///< Executed in all.
  int discarded = 0;     ///< Of these without use.
  int brought_back = 0;  ///< Of these just to get the object away from walls.
  int dropped = 0;       ///< Cases replaced because they were too uncertain.
  int collisions = 0;    ///< Of object or robot with walls, by ground truth.
  double sim_time_s = 0.0;
};

/// Learns an object from scratch, or goes on where an earlier run stopped, in the simulator. Each
/// finished push is in the case base before the next is judged.
/// @param progress  Called before each push; returning false stops, keeping what is finished.
/// @throws InputError from catalog, simulator and options; also if jobs is not in [1, 256].
LearningResult learnInLab(const Catalog& catalog, const std::string& object,
                          const std::string& robot, CaseBase& case_base,
                          const LearningOptions& options,
                          const std::function<bool(const LearningProgress&)>& progress = {});

}  // namespace casepush
