#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "case_chains.h"
#include "casepush/model/case.h"
#include "casepush/planning/prepared_cases.h"
#include "casepush/planning/push_time.h"

namespace casepush {

/// All that a search needs of the cases of one object, whatever the request.
struct CaseSet {
  CaseSet(std::vector<PreparedCase> prepared, const PushTimeOptions& options)
      : cases(std::move(prepared)), time(cases, options), chains(cases, time) {
    for (const PreparedCase& push_case : cases) outcomes.push_back(push_case.start_outcome.mean);
  }

  const std::vector<PreparedCase> cases;
  const PushTime time;
  const CaseChains chains;
  std::vector<Pose2> outcomes;  ///< Mean outcome of each case, side by side.
};

/// Keeps the sets of the last searches: most plans use the very same cases. Thread-safe.
class CaseSetLibrary {
 public:
  using Cases = std::vector<const Case*>;

  /// The set of cases with this content, from `make` if there is none; nullptr if `make` gives
  /// none.
  std::shared_ptr<const CaseSet> get(const Cases& cases, double zeta,
                                     const std::function<std::shared_ptr<const CaseSet>()>& make);

 private:
  static constexpr std::size_t kKept = 8;
  static constexpr std::size_t kMostCases = 256;  // Of a set that is kept.

  struct Entry {
    std::vector<Case> cases;
    double zeta;
    std::shared_ptr<const CaseSet> set;
  };

  std::mutex mutex_;
  std::list<Entry> entries_;  // The one used last comes first.
};

}  // namespace casepush
