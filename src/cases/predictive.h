#pragma once

#include "casepush/cases/outcome_statistics.h"

namespace casepush {

/// Whether an observation lies outside of the 90 % region of the distribution of logPredictive().
/// @pre past.effective_count > 0
bool isSurprising(const OutcomeStatistics& past, const Pose2& start_T_object);

}  // namespace casepush
