#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casepush/execution/exploration.h"
#include "failure_tally.h"
#include "push_candidates.h"

namespace casepush {

/// A case as its exploration sees it.
struct KnownCase {
  Case push_case;
  int serial = 0;
  int repetitions = 0;  ///< Pushes after the first, failed ones included.
  int failed_in_row = 0;
  bool is_new = false;     ///< Found by this run: it may be removed again.
  bool set_aside = false;  ///< Of an earlier run, and failing now: kept, but not practised.
};

struct Exploration::Data {
  Data(const ObjectModel& object, const RobotModel& robot, const ExplorationOptions& given);

  ExplorationOptions options;
  ObjectModel object;
  RobotModel robot;
  PushCandidates candidates;

  std::vector<KnownCase> cases;
  std::optional<Case> to_store;
  int attempt = 0;  ///< First trials so far.
  double accepted_share;
  FailureTally failures;
  int dropped = 0;
  int pushes_of_dropped = 0;

  // Of a robot that drives: what did not work where the object stands, and ways back.
  Pose2 blocked_at;
  std::vector<std::int64_t> blocked_cases;
  std::vector<double> blocked_directions_rad;
  int brought_back = 0;
  int brought_back_in_row = 0;
  std::string stuck;  ///< Why nothing can be pushed any more.

  std::vector<Pose2> outcomes() const;
  bool isPending(const KnownCase& known) const {
    return known.push_case.observation_count < options.practices && !known.set_aside;
  }
  bool wantsCases() const { return static_cast<int>(cases.size()) < options.cases; }
  KnownCase* find(std::int64_t id);
  bool isDone() const;
  bool gaveUp() const;

  Trial practice(const KnownCase& known) const;
  Trial exploring(const PushConfiguration& push) const;
  std::optional<Trial> practiceWithRoom(const PushGround& ground, const Pose2& map_T_object,
                                        double least_room_m) const;
  std::optional<Trial> exploringWithRoom(const PushGround& ground, const Pose2& map_T_object) const;
  std::optional<Trial> wayBack(const PushGround& ground, const Pose2& map_T_object) const;
  void noteBlocked(const Trial& trial);
  bool isBlocked(const KnownCase& known) const;

  bool isUseful(const Trial& trial, const PushReport& report);
  Verdict judgeTrial(const Trial& trial, const PushReport& report, bool was_free);
  Verdict judgeRepetition(const Trial& trial, const PushReport& report, bool was_free,
                          bool has_driven);
  Verdict reject(KnownCase& known);
  bool isTooUncertain(const KnownCase& known) const;
};

}  // namespace casepush
