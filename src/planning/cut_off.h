#pragma once

#include <string>
#include <vector>

#include "plan_search.h"

namespace casepush {

/// Whether walls or furniture keep an object from its goal region for certain.
struct CutOff {
  bool is_certain = false;
  std::string where;  ///< For a person: the place that is too narrow; empty if none can be named.
};

/// First for the object's origin, then for its whole outline, whatever its cases lead to.
/// @param cases  All that pushes are made of.
CutOff findCutOff(const SearchProblem& problem, PushChecker* checker,
                  const std::vector<PreparedCase>& cases, const SearchClock& clock);

/// The place that is too narrow where not even the object's origin gets through: the narrowest one
/// on the shortest way of something thin. Empty if there is none.
std::string placeTooNarrow(const SearchProblem& problem, const CollisionChecker& checker,
                           const SearchClock& clock);

}  // namespace casepush
