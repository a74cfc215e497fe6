#include "casepush/cases/case_upkeep.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

struct Spread {
  double position_m;
  double yaw_rad;
};

Spread spreadOf(const PoseGaussian& outcome) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(
      outcome.covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
  return {std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff())),
          std::sqrt(std::max(0.0, outcome.covariance(2, 2)))};
}

bool areNear(const Pose2& a, const Pose2& b, double distance_m, double turn_rad) {
  return distance(a, b) <= distance_m && std::abs(yawDifference(a, b)) <= turn_rad;
}

bool areDuplicates(const Case& a, const Case& b, const PruneOptions& options) {
  return a.object == b.object && a.robot == b.robot && a.context == b.context &&
         areNear(a.start_outcome.mean, b.start_outcome.mean, options.outcome_distance_m,
                 options.outcome_turn_rad) &&
         areNear(a.steps.front().object_T_robot, b.steps.front().object_T_robot,
                 options.start_distance_m, options.start_turn_rad);
}

std::string whyUseless(const Case& push_case, const PruneOptions& options) {
  std::ostringstream text;
  text.precision(3);
  const Pose2& mean = push_case.start_outcome.mean;
  if (mean.position().norm() < options.least_motion_m &&
      std::abs(mean.yaw()) < options.least_turn_rad) {
    text << "hardly moves the object: " << mean.position().norm() << " m and "
         << std::abs(mean.yaw()) << " rad";
    return text.str();
  }
  const Spread spread = spreadOf(push_case.start_outcome);
  if (push_case.observation_count >= options.least_observations &&
      (spread.position_m > options.largest_sigma_m || spread.yaw_rad > options.largest_sigma_rad)) {
    text << "is too uncertain: " << spread.position_m << " m and " << spread.yaw_rad
         << " rad after " << push_case.observation_count << " observations";
  }
  return text.str();
}

// Best first.
bool isBetter(const Case* a, const Case* b) {
  const auto rank = [](const Case& c) {
    return std::make_tuple(-c.observation_count, c.start_outcome.covariance.determinant(), c.id);
  };
  return rank(*a) < rank(*b);
}

}  // namespace

void PruneOptions::validate() const {
  const std::pair<const char*, double> values[] = {
      {"least_motion_m", least_motion_m},         {"least_turn_rad", least_turn_rad},
      {"largest_sigma_m", largest_sigma_m},       {"largest_sigma_rad", largest_sigma_rad},
      {"outcome_distance_m", outcome_distance_m}, {"outcome_turn_rad", outcome_turn_rad},
      {"start_distance_m", start_distance_m},     {"start_turn_rad", start_turn_rad}};
  for (const auto& [key, value] : values) {
    if (!std::isfinite(value) || value < 0.0) {
      throw InputError(std::string("prune: ") + key,
                       "is " + std::to_string(value) + "; must be finite and >= 0");
    }
  }
}

std::vector<UselessCase> uselessCases(const std::vector<Case>& cases, const PruneOptions& options) {
  options.validate();
  std::map<std::int64_t, std::string> reasons;
  std::vector<const Case*> useful;
  for (const Case& push_case : cases) {
    const std::string reason = whyUseless(push_case, options);
    if (reason.empty()) {
      useful.push_back(&push_case);
    } else {
      reasons[push_case.id] = reason;
    }
  }
  std::sort(useful.begin(), useful.end(), isBetter);
  std::vector<const Case*> kept;
  for (const Case* push_case : useful) {
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const Case* other) {
      return areDuplicates(*push_case, *other, options);
    });
    if (same == kept.end()) {
      kept.push_back(push_case);
    } else {
      reasons[push_case->id] = "does the same as case " + std::to_string((*same)->id);
    }
  }
  std::vector<UselessCase> useless;
  for (const auto& [id, reason] : reasons) {
    useless.push_back({id, reason});
  }
  return useless;
}

double contextDistance(const PushContext& a, const PushContext& b) {
  constexpr double kOtherFloorKg = 1e6;
  constexpr double kNoticedKg = 1e5;  // From what was told to a noticed change, whichever it is.
  const bool other_floor = !a.floor.empty() && !b.floor.empty() && a.floor != b.floor;
  return std::abs(a.load_kg.value_or(0.0) - b.load_kg.value_or(0.0)) +
         (other_floor ? kOtherFloorKg : 0.0) +
         (a.noticed == b.noticed ? 0.0 : kNoticedKg * ((a.noticed > 0) + (b.noticed > 0)));
}

std::vector<Case> learntIn(std::vector<Case> cases, const PushContext& context) {
  const auto is_other = [&](const Case& push_case) {
    return contextDistance(push_case.context, context) > 0.0;
  };
  cases.erase(std::remove_if(cases.begin(), cases.end(), is_other), cases.end());
  return cases;
}

std::map<std::int64_t, std::int64_t> families(const std::vector<Case>& cases) {
  std::map<std::int64_t, const Case*> by_id;
  for (const Case& push_case : cases) {
    by_id[push_case.id] = &push_case;
  }
  std::map<std::int64_t, std::int64_t> family_of;
  for (const auto& [id, push_case] : by_id) {  // Ids ascend, sources come first.
    const auto source = by_id.find(push_case->source_id);
    const bool is_copy = source != by_id.end() && source->first < id &&
                         isFor(*push_case, source->second->object, source->second->robot);
    family_of[id] = is_copy ? family_of[source->first] : id;
  }
  return family_of;
}

std::vector<Case> inContext(const std::vector<Case>& cases, const PushContext& context) {
  const std::map<std::int64_t, std::int64_t> family_of = families(cases);
  const auto rank = [&context](const Case& push_case) {
    return std::make_pair(contextDistance(push_case.context, context), push_case.id);
  };
  std::map<std::int64_t, const Case*> chosen;  // By family.
  for (const Case& push_case : cases) {
    const Case*& best = chosen[family_of.at(push_case.id)];
    if (best == nullptr || rank(push_case) < rank(*best)) {
      best = &push_case;
    }
  }
  std::map<std::int64_t, const Case*> by_id;
  for (const auto& [family, push_case] : chosen) {
    by_id[push_case->id] = push_case;
  }
  std::vector<Case> result;
  for (const auto& [id, push_case] : by_id) {
    result.push_back(*push_case);
  }
  return result;
}

}  // namespace casepush
