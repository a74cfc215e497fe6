#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/execute_push.h"
#include "casepush/model/object_model.h"

namespace casepush {

struct ExplorationOptions {
  int cases = 14;
  int practices = 20;          ///< Pushes per case, the first one included.
  double min_speed_mps = 0.15;
  double max_speed_mps = 0.4;
  double min_duration_s = 1.0;  ///< Paper: 1 to 3 s.
  double max_duration_s = 3.0;
  double start_gap_m = 0.03;    ///< Between robot and object at the start of a push.
  double min_displacement_m = 0.08;   ///< A first trial below both is useless and is replaced.
  double min_rotation_rad = 0.15;
  double max_position_sigma_m = 0.20; ///< A case more uncertain than this is replaced.
  double max_yaw_sigma_rad = 0.6;
  int max_failures = 200;             ///< Useless or failed pushes before learning gives up.
  std::uint64_t seed = 1;
  void validate() const;  ///< @throws InputError listing every violation.
};

/// Decides which push to try next and what to keep; the caller executes and stores.
///
/// First trials start on the object's outline where the robot fits, in directions stratified around
/// it; those whose outcome is not yet covered are kept. Pure logic, deterministic by seed.
class Exploration {
 public:
  Exploration(ObjectModel object, RobotModel robot, ExplorationOptions options);
  ~Exploration();

  /// Continue from cases learnt before (a resumed run).
  void resume(const std::vector<Case>& cases);

  struct Trial {
    std::optional<std::int64_t> case_id;  ///< Practise this case; otherwise try `configuration`.
    PushConfiguration configuration;
    Pose2 object_T_robot;    ///< Where the robot starts in either way.
    int case_number = 0;     ///< From 1, of options.cases.
    int practice_number = 0; ///< From 1, of options.practices.
  };
  /// The next push to execute; nothing if learning is done or has given up.
  std::optional<Trial> next() const;

  /// What to do with the report of the trial that next() gave.
  enum class Verdict {
    kStoreCase,    ///< Store report.recorded as a new case and call stored(id).
    kObserve,      ///< Add report's outcome to the case.
    kDropCase,     ///< Remove the case: too uncertain. It will be replaced.
    kDiscard,      ///< Useless or failed push; nothing to store.
  };
  /// @param updated  For practices: the case with this observation already included.
  Verdict judge(const PushReport& report, const std::optional<Case>& updated);
  void stored(std::int64_t case_id);

  bool finished() const;
  bool gaveUp() const;
  int discarded() const;  ///< Pushes without use so far.
  int dropped() const;    ///< Cases replaced so far.

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace casepush
