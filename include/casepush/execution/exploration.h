#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "casepush/cases/case_base.h"
#include "casepush/execution/execute_push.h"
#include "casepush/execution/push_ground.h"
#include "casepush/model/object_model.h"

namespace casepush {

/// Which pushes are tried.
enum class CoverageStrategy {
  kRandom,  ///< Any push within the limits (paper section 3.2).
  kSpread,  ///< The one that promises outcomes not covered yet; known outcomes are not kept twice.
};
/// "random" or "spread".
const char* toString(CoverageStrategy strategy);
/// @throws InputError if there is no strategy of that name.
CoverageStrategy coverageStrategyFromString(const std::string& name);

struct ExplorationOptions {
  int cases = 20;  ///< Paper: 5 to 14.
  int practices = 20;  ///< Pushes per case, the first one included.
  CoverageStrategy coverage = CoverageStrategy::kSpread;
  double min_speed_mps = 0.15;
  /// At most nine tenths of what the robot can do: it must be able to catch up.
  double max_speed_mps = 0.45;
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
/// true shape towards it; docs/learning.md says how the next one is chosen. A first trial that
/// brings something is kept and practised. A case that turns out too uncertain after five pushes,
/// or fails five times in a row, is dropped and replaced. Pure logic, deterministic by seed and
/// reports.
///
/// Usage:
///   while (auto trial = exploration.next()) {
///     execute it -> report;
///     keep(exploration, *trial, report, case_base, floor);
///   }
/// A robot that drives gives its ground and the object's pose to next(), and its ground to keep().
class Exploration {
 public:
  /// @throws InputError from the options, or if the robot is too slow for `min_speed_mps`.
  Exploration(ObjectModel object, RobotModel robot, ExplorationOptions options);
  ~Exploration();

  /// Continue from cases learnt before (a resumed run); those of other objects or robots are
  /// ignored. Cases short of practices are practised first.
  void resume(const std::vector<Case>& cases);

  struct Trial {
    enum class Kind {
      kExplore,    ///< Try `configuration`.
      kPractise,   ///< Repeat the case.
      kBringBack,  ///< Push the object back to where there is room: repeat the case, if there is
                   ///< one, else `configuration`.
    };
    Kind kind = Kind::kExplore;
    std::optional<std::int64_t> case_id;
    PushConfiguration configuration;
    Pose2 object_T_robot;  ///< Where the robot starts in either way.
    Pose2 object_T_reset;  ///< Where to put the robot if it need not drive there: it docks itself.
    int case_number = 0;   ///< From 1, of options.cases.
    int practice_number = 0;  ///< From 1, of options.practices.
    int serial = 0;           ///< Of the first trial that led to it,
    int repetition = 0;  ///< and how often that was repeated: the two name a push among all others.
  };

  /// The next push to execute if somebody puts object and robot back for each; nothing if learning
  /// is done or has given up. The same until judged.
  std::optional<Trial> next() const;

  /// The next push to execute where the object stands now, for a robot that has to drive.
  ///
  /// The first practice that leaves room around the object; else a first trial that does, if cases
  /// are wanted; else a push back towards the middle of the ground; else whatever does not run into
  /// something. After a push that could not be started something else is chosen. Nothing if
  /// learning is done or has given up, also because nothing can be pushed here.
  std::optional<Trial> next(const PushGround& ground, const Pose2& map_T_object);

  /// What to do with the report of a trial.
  enum class Verdict {
    kStoreCase,  ///< Store report.recorded as a new case and call stored(id).
    kObserve,    ///< Add report's outcome to the case and call observed(case).
    kDropCase,   ///< Remove the case, which this run found: it keeps failing. It will be replaced.
                 ///< Cases of earlier runs are never dropped.
    kDiscard,    ///< Useless or failed push; nothing to store.
  };
  /// @param ground  Where it was pushed, or nullptr: outcomes that walls had a part in are useless.
  Verdict judge(const Trial& trial, const PushReport& report, const PushGround* ground = nullptr);
  void stored(std::int64_t case_id);
  /// @return  False if the case turned out too uncertain and should be removed, see kDropCase.
  bool observed(const Case& updated);

  bool finished() const;
  bool gaveUp() const;
  std::string explanation() const;     ///< Why it gave up, and what to do; for a person.
  int discarded() const;               ///< Pushes without use so far.
  int broughtBack() const;             ///< Pushes just to get the object back.
  int dropped() const;                 ///< Cases replaced so far.
  int pushesDone() const;              ///< Of cases x practices, those there are.
  ExplorationQuality quality() const;  ///< Of the cases known so far.

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// What is stored along with each push.
struct KeepOptions {
  CovarianceFloor floor;
  PushContext context;
};

/// Judges a trial and does what the verdict says with the case base.
/// @return  True if the case base has changed.
bool keep(Exploration& exploration, const Exploration::Trial& trial, const PushReport& report,
          CaseBase& case_base, const KeepOptions& options, const PushGround* ground = nullptr);

}  // namespace casepush
