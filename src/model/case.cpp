#include "casepush/model/case.h"

#include <cmath>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

void require(bool holds, const std::string& where, const std::string& what) {
  if (!holds) {
    throw InputError(where, what);
  }
}

void validateSteps(const Case& push_case, const std::string& where) {
  require(!push_case.steps.empty(), where + ": steps", "is empty; must hold at least one");
  require(
      push_case.push_steps >= 1 && push_case.push_steps <= static_cast<int>(push_case.steps.size()),
      where + ": push_steps",
      "is " + std::to_string(push_case.push_steps) + "; must be in [1, " +
          std::to_string(push_case.steps.size()) + "], the number of steps");
  for (std::size_t i = 0; i < push_case.steps.size(); ++i) {
    const CaseStep& step = push_case.steps[i];
    require(
        step.object_T_robot.isFinite() && step.start_T_object.isFinite() && step.action.isFinite(),
        where + ": steps[" + std::to_string(i) + "]", "is not finite");
  }
}

}  // namespace

void validateCase(const Case& push_case, const std::string& where) {
  require(!push_case.object.empty(), where + ": object", "is empty; must name an object model");
  require(std::isfinite(push_case.period_s) && push_case.period_s > 0.0, where + ": period_s",
          "is " + std::to_string(push_case.period_s) + "; must be finite and above 0");
  validateSteps(push_case, where);
  require(push_case.start_outcome.mean.isFinite(), where + ": start_outcome.mean", "is not finite");
  require(isCovariance(push_case.start_outcome.covariance), where + ": start_outcome.covariance",
          "must be finite, symmetric and without negative eigenvalues");
  require(std::isfinite(push_case.effective_count) && push_case.effective_count >= 0.0,
          where + ": effective_count", "must be finite and not negative");
  require(push_case.observation_count >= 0, where + ": observation_count", "must not be negative");
}

}  // namespace casepush
