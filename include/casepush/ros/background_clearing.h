#pragma once

#include "casepush/execution/clear_way.h"

namespace casepush {

/// Searches for clearing pushes in a thread of their own, so that ticks go on meanwhile. Dropping
/// the result makes the search end, and waits for that: some milliseconds.
BeginClearing searchInBackground(PlannerSource planner, CaseSource cases);

}  // namespace casepush
