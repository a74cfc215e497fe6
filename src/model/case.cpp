#include "casepush/model/case.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "casepush/common/input_error.h"
#include "casepush/model/motion_direction.h"

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
constexpr double kLargestLoad_kg = 10000.0;

bool isNear(const Pose2& pose) {
  return pose.isFinite() && pose.position().cwiseAbs().maxCoeff() <= kLargestCaseCoordinate_m;
}

bool isSlow(const Twist2& action) {
  return action.isFinite() && std::abs(action.vx_mps) <= kLargestSpeed &&
         std::abs(action.vy_mps) <= kLargestSpeed && std::abs(action.wz_rps) <= kLargestSpeed;
}

// True if the sum of all variances shows that none can be too large.
bool isBounded(const Eigen::Matrix3d& covariance) {
  return covariance.trace() <= kLargestSigma * kLargestSigma;
}

void requireSlow(const Twist2& action, const std::string& where) {
  require(action.isFinite(), where, "is not finite");
  if (isSlow(action)) {
    return;
  }
  std::ostringstream text;
  text << "is (" << action.vx_mps << ", " << action.vy_mps << ", " << action.wz_rps
       << "); each must be within " << kLargestSpeed << " (m/s, rad/s) of 0";
  throw InputError(where, text.str());
}

void requireShort(double path_m, const char* body, const std::string& where) {
  if (path_m > kLargestPath_m) {
    std::ostringstream text;
    text << "let the " << body << " travel " << path_m << " m; must be at most " << kLargestPath_m
         << " m";
    throw InputError(where + ": steps", text.str());
  }
}

// A trajectory may stay near and yet be endless when it jumps to and fro.
void validatePaths(const Case& push_case, const std::string& where) {
  double object_m = 0.0;
  double robot_m = 0.0;
  Pose2 robot;
  for (std::size_t i = 0; i < push_case.steps.size(); ++i) {
    const CaseStep& step = push_case.steps[i];
    const Pose2 next_robot = step.start_T_robot();
    if (i > 0) {
      object_m += distance(push_case.steps[i - 1].start_T_object, step.start_T_object);
      robot_m += distance(robot, next_robot);
    }
    robot = next_robot;
  }
  requireShort(object_m, "object", where);
  requireShort(robot_m, "robot", where);
}

void validateOutcome(const PoseGaussian& outcome, const std::string& where) {
  validateCasePose(outcome.mean, where + ".mean");
  require(isCovariance(outcome.covariance), where + ".covariance",
          "must be finite, symmetric and without negative eigenvalues");
  const double sigma = std::sqrt(outcome.covariance.diagonal().maxCoeff());
  if (sigma > kLargestSigma) {
    std::ostringstream text;
    text << "has a standard deviation of " << sigma << "; must be at most " << kLargestSigma
         << " (m, rad)";
    throw InputError(where + ".covariance", text.str());
  }
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
    if (isNear(step.object_T_robot) && isNear(step.start_T_object) && isSlow(step.action)) {
      continue;
    }
    const std::string step_where = where + ": steps[" + std::to_string(i) + "]";
    validateCasePose(step.object_T_robot, step_where + ".object_T_robot");
    validateCasePose(step.start_T_object, step_where + ".start_T_object");
    requireSlow(step.action, step_where + ".action");
  }
  validatePaths(push_case, where);
}

void validateTube(const Case& push_case, const std::string& where) {
  const std::vector<PoseGaussian>& tube = push_case.tube;
  require(tube.empty() || tube.size() == push_case.steps.size(), where + ": tube",
          "holds " + std::to_string(tube.size()) + " poses; must hold one for each of the " +
              std::to_string(push_case.steps.size()) + " steps, or none");
  for (std::size_t i = 0; i < tube.size(); ++i) {
    if (!isNear(tube[i].mean) || !isCovariance(tube[i].covariance) ||
        !isBounded(tube[i].covariance)) {
      validateOutcome(tube[i], where + ": tube[" + std::to_string(i) + "]");
    }
  }
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

void validateCasePose(const Pose2& pose, const std::string& where) {
  require(pose.isFinite(), where, "is not finite");
  if (isNear(pose)) {
    return;
  }
  std::ostringstream text;
  text << "is at (" << pose.x() << ", " << pose.y() << "); x and y must be within "
       << kLargestCaseCoordinate_m << " m of 0";
  throw InputError(where, text.str());
}

void validateContext(const PushContext& context, const std::string& where) {
  const double load_kg = context.load_kg.value_or(0.0);
  if (!(load_kg >= 0.0 && load_kg <= kLargestLoad_kg)) {
    std::ostringstream text;
    text << "is " << load_kg << "; must be in [0, " << kLargestLoad_kg << "] kg";
    throw InputError(where + ": load_kg", text.str());
  }
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  require(std::none_of(context.floor.begin(), context.floor.end(), is_control), where + ": floor",
          "holds a control character; must be a text on one line");
  require(context.noticed >= 0, where + ": noticed", "must not be negative");
}

void validateCase(const Case& push_case, const std::string& where) {
  require(!push_case.object.empty(), where + ": object", "is empty; must name an object model");
  if (!(push_case.period_s >= kShortestPeriod_s && push_case.period_s <= kLongestPeriod_s)) {
    std::ostringstream period;
    period << "is " << push_case.period_s << "; must be in [" << kShortestPeriod_s << ", "
           << kLongestPeriod_s << "] s";
    throw InputError(where + ": period_s", period.str());
  }
  validateSteps(push_case, where);
  validateOutcome(push_case.start_outcome, where + ": start_outcome");
  validateTube(push_case, where);
  validateContext(push_case.context, where);
  if (!(push_case.effective_count > 0.0 && push_case.effective_count <= kLargestCount)) {
    std::ostringstream count;
    count << "is " << push_case.effective_count << "; must be above 0 and at most "
          << kLargestCount;
    throw InputError(where + ": effective_count", count.str());
  }
  require(push_case.observation_count >= 0, where + ": observation_count", "must not be negative");
}

double pushDirection(const Case& push_case) {
  std::vector<Pose2> poses;
  for (const CaseStep& step : push_case.steps) poses.push_back(step.start_T_robot());
  // A push that only turns: towards the object.
  return motionDirection(poses).value_or(std::atan2(-poses.front().y(), -poses.front().x()));
}

const Case* findCase(const std::vector<Case>& cases, std::int64_t id) {
  const Case* copy = nullptr;
  for (const Case& push_case : cases) {
    if (push_case.id == id) return &push_case;
    if (push_case.source_id == id && copy == nullptr) copy = &push_case;
  }
  return copy;
}

bool isFor(const Case& push_case, const std::string& object, const std::string& robot) {
  return push_case.object == object && push_case.robot == robot;
}

}  // namespace casepush
