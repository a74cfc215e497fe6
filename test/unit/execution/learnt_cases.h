#pragma once

#include <cstdint>
#include <map>

#include "casepush/cases/outcome_statistics.h"
#include "casepush/execution/exploration.h"

namespace casepush::test {

inline ExplorationOptions explorationOptions(int cases, int practices, std::uint64_t seed) {
  ExplorationOptions options;
  options.cases = cases;
  options.practices = practices;
  options.seed = seed;
  return options;
}

/// What a caller of Exploration stores, in memory.
struct LearntCases {
  /// Does with a report what the exploration says.
  Exploration::Verdict judge(Exploration& exploration, const Exploration::Trial& trial,
                             const PushReport& report, const PushGround* ground = nullptr) {
    const Exploration::Verdict verdict = exploration.judge(trial, report, ground);
    if (verdict == Exploration::Verdict::kStoreCase) {
      const std::int64_t id = ++last_id;
      cases[id] = report.recorded;
      cases[id].id = id;
      exploration.stored(id);
    } else if (verdict == Exploration::Verdict::kObserve) {
      Case& known = cases.at(*trial.case_id);
      observe(known, report.recorded.start_outcome.mean);
      if (!exploration.observed(known)) {
        cases.erase(*trial.case_id);
      }
    } else if (verdict == Exploration::Verdict::kDropCase) {
      cases.erase(*trial.case_id);
    }
    return verdict;
  }

  static void observe(Case& push_case, const Pose2& start_T_object) {
    const OutcomeStatistics now = addObservation(
        {push_case.start_outcome, push_case.effective_count}, start_T_object, CovarianceFloor{});
    push_case.start_outcome = now.start_outcome;
    push_case.effective_count = now.effective_count;
    ++push_case.observation_count;
  }

  std::map<std::int64_t, Case> cases;
  std::int64_t last_id = 0;
};

}  // namespace casepush::test
