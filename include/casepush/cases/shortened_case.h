#pragma once

#include <optional>
#include <vector>

#include "casepush/model/case.h"

namespace casepush {

/// A case with a part of its push at full speed left out: the robot sets off and brakes as
/// recorded, so that the object coasts as recorded, too, and comes to rest nearer to its start.
///
/// Where a whole case does not fit, such a one may. Its outcome is what the case's mean trajectory
/// says; the covariance stays that of the whole case, which scatters more.
/// @param share  Of the steps at full speed, what is kept: in [0, 1).
/// @return  Nothing if there is nothing to leave out, or if the robot moved along the object by
///   more than 4 cm or 0.15 rad meanwhile, so that the two ends do not fit together. Its id is
///   negative: it is not stored, and what it does teaches the case nothing.
/// @pre The case passes validateCase and has a positive id.
std::optional<Case> shortenedCase(const Case& push_case, double share);

/// The cases and, after them, the shortened ones of each, unless they hold some already. More than
/// 500 cases are left alone: so many hold short pushes enough.
std::vector<Case> withShortened(std::vector<Case> cases);

/// Was it made by shortenedCase()?
inline bool isShortened(const Case& push_case) { return push_case.id < 0; }

}  // namespace casepush
