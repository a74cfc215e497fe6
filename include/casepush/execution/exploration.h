#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/model/object_model.h"

namespace casepush {

struct ExplorationOptions {
  int cases = 14;
  int practices = 20;  ///< Pushes per case, the first one included.
  double min_speed_mps = 0.15;
  double max_speed_mps = 0.4;
  double min_duration_s = 1.0;  ///< Paper: 1 to 3 s.
  double max_duration_s = 3.0;
  double start_gap_m = 0.03;         ///< Between robot and object at the start of a push.
  double min_displacement_m = 0.08;  ///< A first trial below both is useless and is replaced.
  double min_rotation_rad = 0.15;
  double max_position_sigma_m = 0.20;  ///< A case more uncertain than this is replaced.
  double max_yaw_sigma_rad = 0.6;
  int max_failures = 200;  ///< Useless or failed pushes, those of dropped cases included, before
                           ///< learning gives up.
  std::uint64_t seed = 1;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// How good a set of cases is, in numbers.
struct ExplorationQuality {
  int cases = 0;
  int complete_cases = 0;  ///< With all their practices.
  int observations = 0;
  double mean_position_sigma_m = 0.0;  ///< Of the outcomes, along their longest axis.
  double max_position_sigma_m = 0.0;
  double mean_yaw_sigma_rad = 0.0;
  double max_yaw_sigma_rad = 0.0;
  double shortest_m = 0.0;  ///< Displacements of the mean outcomes.
  double longest_m = 0.0;
  int left_turns = 0;  ///< Cases that turn the object by more than 0.3 rad.
  int right_turns = 0;
  double widest_gap_rad = 0.0;  ///< Between directions of displacement in the object frame.
};

/// Decides which push to try next and what to keep; the caller executes and stores.
///
/// First trials start on the object's outline where the robot fits, found by sliding the robot's
/// true shape towards it. Directions fill the widest gaps between those known; lever arm, speed and
/// duration balance left and right turns, short and long pushes. A first trial whose outcome is not
/// yet covered is kept and practised; the distance asked for relaxes with each trial that is not. A
/// case that turns out too uncertain after five pushes, or fails five times in a row, is dropped
/// and replaced. Pure logic, deterministic by seed and reports.
///
/// Usage:
///   while (auto trial = exploration.next()) {
///     execute it -> report;
///     if (trial->case_id && isObservation(report)) updated = case with that outcome added;
///     switch (exploration.judge(report, updated)) ...   // see Verdict
///   }
class Exploration {
 public:
  Exploration(ObjectModel object, RobotModel robot, ExplorationOptions options);
  ~Exploration();

  /// Continue from cases learnt before (a resumed run); those of other objects or robots are ignored. Cases short of practices are practised
  /// first.
  void resume(const std::vector<Case>& cases);

  struct Trial {
    std::optional<std::int64_t> case_id;  ///< Practise this case; otherwise try `configuration`.
    PushConfiguration configuration;
    Pose2 object_T_robot;  ///< Where the robot starts in either way.
    Pose2 object_T_reset;  ///< Where to put the robot if it need not drive there: it docks itself.
    int case_number = 0;   ///< From 1, of options.cases.
    int practice_number = 0;  ///< From 1, of options.practices.
  };
  /// The next push to execute; nothing if learning is done or has given up. The same until judged.
  /// @pre stored() was called if judge() said kStoreCase.
  std::optional<Trial> next() const;

  /// What to do with the report of the trial that next() gave.
  enum class Verdict {
    kStoreCase,  ///< Store report.recorded as a new case and call stored(id).
    kObserve,    ///< Add report's outcome to the case.
    kDropCase,   ///< Remove the case, which this run found: too uncertain, or it keeps failing. It
                 ///< will be replaced. Cases of earlier runs are never dropped.
    kDiscard,    ///< Useless or failed push; nothing to store.
  };
  /// @param updated  For practices: the case with this observation already included; nothing if the
  ///   push was no observation.
  Verdict judge(const PushReport& report, const std::optional<Case>& updated);
  void stored(std::int64_t case_id);

  bool finished() const;
  bool gaveUp() const;
  std::string explanation() const;     ///< Why it gave up, and what to do; for a person.
  int discarded() const;               ///< Pushes without use so far.
  int dropped() const;                 ///< Cases replaced so far.
  ExplorationQuality quality() const;  ///< Of the cases known so far.

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
