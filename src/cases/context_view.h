#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "casepush/cases/case_upkeep.h"
#include "casepush/cases/context_shift.h"

namespace casepush {

/// Cases of one object, seen from one context.
class ContextView {
 public:
  ContextView(std::vector<Case> cases, const PushContext& context);

  /// The case of an id's family that was learnt in the context; null if there is none.
  const Case* member(std::int64_t id) const;

  /// What is expected of a case in the context: the case itself if it was learnt there or the
  /// context is unknown, else a conjecture from the others that are known in both.
  Case expected(const Case& push_case);

 private:
  std::vector<Case> cases_;
  PushContext context_;
  std::map<std::int64_t, std::int64_t> family_of_;
  std::map<std::int64_t, const Case*> members_;               ///< By family.
  std::vector<std::pair<PushContext, ContextShift>> shifts_;  ///< From where, as far as asked for.
};

}  // namespace casepush
