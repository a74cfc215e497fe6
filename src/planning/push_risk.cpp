#include "push_risk.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include "casepush/common/check.h"
#include "casepush/common/input_error.h"
#include "casepush/common/normal_samples.h"
#include "casepush/model/plan_scatter.h"

namespace casepush {
namespace {

constexpr std::uint64_t kSeed = 1;
/// Standardised radii at which a direction is tested: fine enough for a factor of about two in what
/// lies beyond.
constexpr std::array<double, 8> kRadii = {0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0};
/// Coarser, where a few hundredths are no matter.
constexpr std::array<double, 4> kCoarseRadii = {0.75, 1.5, 2.25, 3.0};

/// Probability that a standard normal in three dimensions is farther out.
double beyond(double radius) {
  return std::erfc(radius * M_SQRT1_2) +
         std::sqrt(2.0 / M_PI) * radius * std::exp(-0.5 * radius * radius);
}

/// Probability of all that lies behind the first obstacle in a direction.
/// @param radii  Where `collides` is asked, ascending.
template <std::size_t kCount, typename Collides>
double blockedBeyond(const std::array<double, kCount>& radii, const Collides& collides) {
  if (!collides(radii.back())) return 0.0;
  std::size_t free = 0;  // Radii before this one are free, as the mean is.
  std::size_t blocked = kCount - 1;
  while (free < blocked) {
    const std::size_t middle = (free + blocked) / 2;
    if (collides(radii[middle])) {
      blocked = middle;
    } else {
      free = middle + 1;
    }
  }
  const double inside = blocked > 0 ? radii[blocked - 1] : 0.0;
  return 0.5 * (beyond(inside) + beyond(radii[blocked]));
}

/// Any root does for isotropic directions; this one takes few operations.
Eigen::Matrix3d rootOf(const Eigen::Matrix3d& covariance) {
  const Eigen::LLT<Eigen::Matrix3d> llt(covariance);
  return llt.info() == Eigen::Success ? Eigen::Matrix3d(llt.matrixL()) : covarianceRoot(covariance);
}

/// What the rest of a plan may risk. Twice what a new plan may: else every rest near the limit
/// would be planned anew for the least deviation.
double bearable(const PushPlan& rest) {
  constexpr double kSlack = 2.0;
  return kSlack * rest.max_collision_probability.value_or(1.0);
}

}  // namespace

const char* toString(RiskModel model) {
  return model == RiskModel::kChance ? "chance" : "sigma_points";
}

RiskModel riskModel(const std::string& name) {
  for (const RiskModel model : {RiskModel::kSigmaPoints, RiskModel::kChance}) {
    if (name == toString(model)) return model;
  }
  throw InputError("risk", "\"" + name + "\" is none of sigma_points, chance");
}

/// Roots of covariances; nothing for what needs no test.
struct PushRisk::Deviations {
  std::optional<Eigen::Matrix3d> start;
  std::vector<std::pair<Pose2, Eigen::Matrix3d>> stops;  ///< With the mean in the start frame.
};

PushRisk::PushRisk(std::vector<const Case*> cases, const std::vector<PreparedCase>& prepared,
                   PushChecker* checker, const RiskOptions& options)
    : prepared_(prepared),
      checker_(*checker),
      options_(options),
      cases_(std::move(cases)),
      motions_(cases_.size()) {
  for (const Eigen::Vector3d& normal : normalSamples(kDirections, kSeed)) {
    directions_.push_back(normal.normalized());
  }
}

const PushRisk::Motion& PushRisk::motion(int push) const {
  std::optional<Motion>& known = motions_[push];
  if (!known) known = Motion{stopsOf(*cases_[push]), guardsOf(*cases_[push])};
  return *known;
}

// Half way, at three quarters and at the end: scatter grows along the way.
std::vector<PushRisk::Stop> PushRisk::stopsOf(const Case& push_case) {
  const Pose2 outcome = push_case.start_outcome.mean;
  const double length_m = outcome.position().norm();
  std::vector<Stop> stops;
  const auto add = [&stops](const PoseGaussian& pose) {
    stops.push_back({pose.mean, adjointSe2(pose.mean.inverse()), pose.covariance});
  };
  for (const double share : {0.5, 0.75}) {
    std::size_t step = 0;
    while (step + 1 < push_case.steps.size() &&
           push_case.steps[step].start_T_object.position().norm() < share * length_m) {
      ++step;
    }
    if (push_case.tube.size() == push_case.steps.size()) {
      add(push_case.tube[step]);
    } else {
      add({push_case.steps[step].start_T_object,
           share * share * push_case.start_outcome.covariance});
    }
  }
  add(push_case.start_outcome);
  return stops;
}

Eigen::Matrix3d PushRisk::compounded(const std::vector<int>& pushes, int count) const {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = std::min(static_cast<int>(pushes.size()), count) - 1; i >= 0; --i) {
    const Stop& end = motion(pushes[i]).stops.back();
    covariance = end.carry * covariance * end.carry.transpose() + end.covariance;
  }
  return covariance;
}

Eigen::Matrix3d PushRisk::startCovariance(const std::vector<int>& pushes) const {
  return compounded(pushes, options_.horizon - 1);
}

Eigen::Matrix3d PushRisk::driftedCovariance(const std::vector<int>& pushes) const {
  return compounded(pushes, pushesThatCount());
}

PushRisk::Guards PushRisk::guardsOf(const Case& push_case) {
  constexpr double kRange_m = 0.12;
  const auto note = [](const Eigen::Vector2d& point, std::vector<Guard>* guards) {
    const double off_m =
        guards->empty() ? 2.0 * kRange_m : (point - guards->back().start_point_m).norm();
    if (off_m > kRange_m) {
      guards->push_back({point, off_m});  // The way up to it belongs to it, too.
    } else {
      guards->back().range_m = std::max(guards->back().range_m, off_m);
    }
  };
  Guards guards;
  for (const CaseStep& step : push_case.steps) {
    note(step.start_T_object.position(), &guards.object);
    note(step.start_T_robot().position(), &guards.robot);
  }
  return guards;
}

bool PushRisk::isMotionFarFromAll(int push, const Pose2& map_T_start,
                                  const Eigen::Matrix3d& start_covariance) const {
  const double shift_m = kRadii.back() * std::sqrt(start_covariance.topLeftCorner<2, 2>().trace());
  const double turn_rad = kRadii.back() * std::sqrt(start_covariance(2, 2));
  const auto deviation = [&](const Guard& guard) {
    return shift_m + turn_rad * guard.start_point_m.norm() + guard.range_m;
  };
  const Guards& guards = motion(push).guards;
  return std::all_of(guards.object.begin(), guards.object.end(),
                     [&](const Guard& guard) {
                       return checker_.isObjectFarFromAll(map_T_start * guard.start_point_m,
                                                          deviation(guard));
                     }) &&
         std::all_of(guards.robot.begin(), guards.robot.end(), [&](const Guard& guard) {
           return checker_.isRobotFarFromAll(map_T_start * guard.start_point_m, deviation(guard));
         });
}

// Whatever is so far from everything that no deviation counts is left out.
PushRisk::Deviations PushRisk::deviationsOf(int push, const Pose2& map_T_start,
                                            const Eigen::Matrix3d& start_covariance) const {
  Deviations deviations;
  const bool is_known = start_covariance.isZero(0.0);
  if (!is_known && !isMotionFarFromAll(push, map_T_start, start_covariance)) {
    deviations.start = rootOf(start_covariance);
  }
  for (const Stop& stop : motion(push).stops) {
    const Eigen::Matrix3d covariance =
        stop.carry * start_covariance * stop.carry.transpose() + stop.covariance;
    const double shift_m = kRadii.back() * std::sqrt(covariance.topLeftCorner<2, 2>().trace());
    const Eigen::Vector2d position_m = map_T_start * stop.start_T_object.position();
    if (!checker_.isObjectFarFromAll(position_m, shift_m)) {
      deviations.stops.emplace_back(stop.start_T_object, rootOf(covariance));
    }
  }
  return deviations;
}

bool PushRisk::collidesAt(int push, const Pose2& map_T_start, const Deviations& deviations,
                          const Eigen::Vector3d& offset) const {
  for (std::size_t i = deviations.stops.size(); i-- > 0;) {
    const auto& [start_T_object, root] = deviations.stops[i];
    if (!checker_.isFree(map_T_start * start_T_object * expSe2(root * offset))) return true;
  }
  return deviations.start.has_value() &&
         !checker_.isSafe(prepared_[push], map_T_start * expSe2(*deviations.start * offset));
}

double PushRisk::collisionProbability(int push, const Pose2& map_T_start,
                                      const Eigen::Matrix3d& start_covariance, double limit) const {
  if (!checker_.isSafe(prepared_[push], map_T_start)) return 1.0;
  const Deviations deviations = deviationsOf(push, map_T_start, start_covariance);
  if (!deviations.start && deviations.stops.empty()) return 0.0;
  double probability = 0.0;
  for (const Eigen::Vector3d& direction : directions_) {
    const double blocked = blockedBeyond(kRadii, [&](double radius) {
      return collidesAt(push, map_T_start, deviations, radius * direction);
    });
    probability += blocked / kDirections;
    if (probability > limit) break;
  }
  return std::min(1.0, probability);
}

double PushRisk::obstructionProbability(int push, const Pose2& map_T_start,
                                        const Eigen::Matrix3d& start_covariance) const {
  if (start_covariance.isZero(0.0) || isMotionFarFromAll(push, map_T_start, start_covariance)) {
    return 0.0;
  }
  const Eigen::Matrix3d root = rootOf(start_covariance);
  double probability = 0.0;
  for (int i = 0; i < kCoarseDirections; ++i) {
    const Eigen::Vector3d offset = root * directions_[i];
    probability += blockedBeyond(kCoarseRadii, [&](double radius) {
      return checker_.mayCollide(prepared_[push], map_T_start * expSe2(radius * offset));
    });
  }
  return probability / kCoarseDirections;
}

double PushRisk::missProbability(int push, const Pose2& map_T_start,
                                 const Eigen::Matrix3d& start_covariance, const Pose2& map_T_goal,
                                 const GoalTolerance& tolerance) const {
  const Stop& end = motion(push).stops.back();
  const PoseGaussian pose =
      compound({map_T_start, start_covariance}, {end.start_T_object, end.covariance});
  return 1.0 - goalProbability(pose, map_T_goal, tolerance);
}

double PushRisk::expectedReplans(int push, const GoalTolerance& tolerance) const {
  const Eigen::Matrix3d& covariance = cases_[push]->start_outcome.covariance;
  const double shifts =
      covariance.topLeftCorner<2, 2>().trace() / (tolerance.position_m * tolerance.position_m);
  const double turns = covariance(2, 2) / (tolerance.yaw_rad * tolerance.yaw_rad);
  return std::min(1.0, shifts + turns);
}

void assessPlan(const PushRisk& risk, const std::vector<int>& pushes, PushPlan* plan) {
  std::vector<int> before;  // The last one first.
  double sum = 0.0;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    PlannedPush& push = plan->pushes[i];
    push.collision_probability =
        risk.collisionProbability(pushes[i], push.map_T_start, risk.startCovariance(before));
    sum += riskOf(push.collision_probability);
    before.insert(before.begin(), pushes[i]);
  }
  plan->collision_probability = probabilityOf(sum);
}

std::vector<SafetyLevel> safetyLevels(const RiskOptions& options, double zeta) {
  std::vector<SafetyLevel> levels;
  if (options.model == RiskModel::kChance) {
    levels.push_back({0.0, options.max_collision_probability});
    for (const double level : {0.1, 0.2, 0.5, 1.0}) {
      if (level > options.max_collision_probability) levels.push_back({0.0, level});
    }
    for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
      levels[i].deadline_share = 1.0 - 0.5 * std::pow(0.6, static_cast<double>(i));
    }
    return levels;
  }
  levels.push_back({zeta, {}});
  for (double level = std::ceil(zeta) - 1.0; level >= 0.0; level -= 1.0) {
    levels.push_back({level, {}});
  }
  return levels;
}

void assessPlan(const std::vector<Case>& cases, const PreparationSizes& sizes,
                const RiskOptions& options, PushChecker* checker, PushPlan* plan) {
  std::vector<const Case*> used;
  std::vector<PreparedCase> prepared;
  std::vector<int> pushes;
  for (const PlannedPush& push : plan->pushes) {
    const Case* found = findCase(cases, push.case_id);
    CASEPUSH_CHECK(found != nullptr, "no case " << push.case_id);
    pushes.push_back(static_cast<int>(used.size()));
    used.push_back(found);
    prepared.push_back(
        prepareCase(*found, 0.0, sizes.step_m, sizes.object_radius_m, sizes.robot_radius_m));
  }
  assessPlan(PushRisk(std::move(used), prepared, checker, options), pushes, plan);
}

int bearablePushes(const PushPlan& rest) {
  double sum = 0.0;
  int count = 0;
  for (const PlannedPush& push : rest.pushes) {
    sum += riskOf(push.collision_probability);
    if (probabilityOf(sum) > bearable(rest)) break;
    ++count;
  }
  return count;
}

std::string riskExplanation(const PushPlan& rest) {
  if (rest.collision_probability <= bearable(rest)) return {};
  std::ostringstream text;
  text << std::fixed << std::setprecision(2)
       << "the rest of the plan now collides with probability " << rest.collision_probability
       << ", and " << *rest.max_collision_probability << " was wanted";
  return text.str();
}

double riskOf(double probability) {
  return probability < 1.0 ? -std::log1p(-probability) : std::numeric_limits<double>::infinity();
}

double probabilityOf(double risk) { return -std::expm1(-risk); }

}  // namespace casepush
