#include "casepush/model/case.h"

#include <cmath>
#include <sstream>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

void require(bool holds, const std::string& where, const std::string& what) {
  if (!holds) {
    throw InputError(where, what);
  }
}

// Far beyond any push, near enough that sampling, planning and drawing one remain possible.
constexpr double kLargestPath_m = 1000.0;
constexpr double kLargestSpeed = 10.0;  // m/s and rad/s
constexpr double kShortestPeriod_s = 1e-3;
constexpr double kLongestPeriod_s = 10.0;
constexpr std::size_t kMostSteps = 10000;
constexpr double kLargestSigma = 100.0;  // m and rad
constexpr double kLargestCount = 1e9;

void requireNear(const Pose2& pose, const std::string& where) {
  require(pose.isFinite(), where, "is not finite");
  if (pose.position().cwiseAbs().maxCoeff() <= kLargestCaseCoordinate_m) {
    return;
  }
  std::ostringstream text;
  text << "is at (" << pose.x() << ", " << pose.y() << "); x and y must be within "
       << kLargestCaseCoordinate_m << " m of 0";
  throw InputError(where, text.str());
}

void requireSlow(const Twist2& action, const std::string& where) {
  require(action.isFinite(), where, "is not finite");
  if (std::abs(action.vx_mps) <= kLargestSpeed && std::abs(action.vy_mps) <= kLargestSpeed &&
      std::abs(action.wz_rps) <= kLargestSpeed) {
    return;
  }
  std::ostringstream text;
  text << "is (" << action.vx_mps << ", " << action.vy_mps << ", " << action.wz_rps
       << "); each must be within " << kLargestSpeed << " (m/s, rad/s) of 0";
  throw InputError(where, text.str());
}

void requireShort(double path_m, const char* body, const std::string& where) {
  std::ostringstream text;
  text << "let the " << body << " travel " << path_m << " m; must be at most " << kLargestPath_m
       << " m";
  require(path_m <= kLargestPath_m, where, text.str());
}

// A trajectory may stay near and yet be endless when it jumps to and fro.
void validatePaths(const Case& push_case, const std::string& where) {
  double object_m = 0.0;
  double robot_m = 0.0;
  for (std::size_t i = 1; i < push_case.steps.size(); ++i) {
    const CaseStep& from = push_case.steps[i - 1];
    const CaseStep& to = push_case.steps[i];
    object_m += distance(from.start_T_object, to.start_T_object);
    robot_m += distance(from.start_T_robot(), to.start_T_robot());
  }
  requireShort(object_m, "object", where + ": steps");
  requireShort(robot_m, "robot", where + ": steps");
}

void validateOutcome(const PoseGaussian& outcome, const std::string& where) {
  requireNear(outcome.mean, where + ".mean");
  require(isCovariance(outcome.covariance), where + ".covariance",
          "must be finite, symmetric and without negative eigenvalues");
  const double sigma = std::sqrt(outcome.covariance.diagonal().maxCoeff());
  std::ostringstream text;
  text << "has a standard deviation of " << sigma << "; must be at most " << kLargestSigma
       << " (m, rad)";
  require(sigma <= kLargestSigma, where + ".covariance", text.str());
}

void validateSteps(const Case& push_case, const std::string& where) {
  require(!push_case.steps.empty(), where + ": steps", "is empty; must hold at least one");
  require(push_case.steps.size() <= kMostSteps, where + ": steps",
          "are " + std::to_string(push_case.steps.size()) + "; must be at most " +
              std::to_string(kMostSteps));
  require(
      push_case.push_steps >= 1 && push_case.push_steps <= static_cast<int>(push_case.steps.size()),
      where + ": push_steps",
      "is " + std::to_string(push_case.push_steps) + "; must be in [1, " +
          std::to_string(push_case.steps.size()) + "], the number of steps");
  for (std::size_t i = 0; i < push_case.steps.size(); ++i) {
    const CaseStep& step = push_case.steps[i];
    const std::string step_where = where + ": steps[" + std::to_string(i) + "]";
    requireNear(step.object_T_robot, step_where + ".object_T_robot");
    requireNear(step.start_T_object, step_where + ".start_T_object");
    requireSlow(step.action, step_where + ".action");
  }
  validatePaths(push_case, where);
}

}  // namespace

const char* toString(CaseOrigin origin) {
  switch (origin) {
    case CaseOrigin::kExplored:
      return "explored";
    case CaseOrigin::kDemonstrated:
      return "demonstrated";
    case CaseOrigin::kTransferred:
      break;
  }
  return "transferred";
}

void validateCase(const Case& push_case, const std::string& where) {
  require(!push_case.object.empty(), where + ": object", "is empty; must name an object model");
  std::ostringstream period;
  period << "is " << push_case.period_s << "; must be in [" << kShortestPeriod_s << ", "
         << kLongestPeriod_s << "] s";
  require(push_case.period_s >= kShortestPeriod_s && push_case.period_s <= kLongestPeriod_s,
          where + ": period_s", period.str());
  validateSteps(push_case, where);
  validateOutcome(push_case.start_outcome, where + ": start_outcome");
  std::ostringstream count;
  count << "is " << push_case.effective_count << "; must be above 0 and at most " << kLargestCount;
  require(push_case.effective_count > 0.0 && push_case.effective_count <= kLargestCount,
          where + ": effective_count", count.str());
  require(push_case.observation_count >= 0, where + ": observation_count", "must not be negative");
}

bool isFor(const Case& push_case, const std::string& object, const std::string& robot) {
  return push_case.object == object && push_case.robot == robot;
}

}  // namespace casepush
